// Vectors of the plane: the identities that the mechanics relies on.
#include "catena/base/vec2.hpp"

#include <gtest/gtest.h>

#include "catena/base/dual.hpp"

namespace catena {
namespace {

TEST(Vec2, Arithmetic) {
  const Vec2<double> a{3, -4}, b{0.5, 2};
  EXPECT_EQ(a + b, (Vec2<double>{3.5, -2}));
  EXPECT_EQ(a - b, (Vec2<double>{2.5, -6}));
  EXPECT_EQ(-a, (Vec2<double>{-3, 4}));
  EXPECT_EQ(2.0 * a, (Vec2<double>{6, -8}));
  EXPECT_EQ(a * 2.0, 2.0 * a);
  EXPECT_EQ(a / 2.0, (Vec2<double>{1.5, -2}));
  Vec2<double> c = a;
  EXPECT_EQ(c += b, a + b);
  EXPECT_EQ(c -= b, a);
}

TEST(Vec2, ProductsFollowTheTurningRule) {
  const Vec2<double> a{3, -4}, b{0.5, 2};
  EXPECT_EQ(dot(a, b), -6.5);
  EXPECT_EQ(cross(a, b), 8.0);
  EXPECT_EQ(cross(b, a), -8.0);
  EXPECT_EQ(perpendicular(Vec2<double>{1, 0}), (Vec2<double>{0, 1}));
  EXPECT_EQ(dot(perpendicular(a), b), cross(a, b));
  EXPECT_EQ(perpendicular(perpendicular(a)), -a);
  EXPECT_EQ(squared_norm(a), 25.0);
  EXPECT_EQ(norm(a), 5.0);
}

TEST(Vec2, NormOfDualsIsTheUnitVector) {
  using D = Dual<double, 2>;
  const D length = norm(Vec2<D>{D::variable(3, 0), D::variable(-4, 1)});
  EXPECT_EQ(length.v, 5.0);
  EXPECT_DOUBLE_EQ(length.d[0], 0.6);
  EXPECT_DOUBLE_EQ(length.d[1], -0.8);
}

}  // namespace
}  // namespace catena
