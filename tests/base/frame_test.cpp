// Body frames: the turning of points and axes, and the derivatives that seeding gives them, against closed forms.
#include "catena/base/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace catena {
namespace {

constexpr double x = 0.3, y = -1.2, phi = 2.1;
constexpr Vec2<double> local{0.7, 0.4};

TEST(Frame, PointsAndAxes) {
  const Frame<double> f = make_frame(x, y, phi);
  const double c = std::cos(phi), s = std::sin(phi);
  const Vec2<double> axis = f.axis(local), point = f.point(local);
  EXPECT_DOUBLE_EQ(axis.x, c * 0.7 - s * 0.4);
  EXPECT_DOUBLE_EQ(axis.y, s * 0.7 + c * 0.4);
  EXPECT_DOUBLE_EQ(point.x, x + axis.x);
  EXPECT_DOUBLE_EQ(point.y, y + axis.y);
  const Vec2<double> back = f.to_local(axis);
  EXPECT_NEAR(back.x, local.x, 1e-15);
  EXPECT_NEAR(back.y, local.y, 1e-15);
  EXPECT_EQ(f.origin(), (Vec2<double>{x, y}));
}

TEST(Frame, DefaultIsTheGround) {
  const Frame<double> ground;
  EXPECT_EQ(ground.point(local), local);
  const Frame<Dual<double, 3>> constant = constant_frame<Dual<double, 3>>(make_frame(x, y, phi));
  for (const Dual<double, 3>& value : {constant.x, constant.y, constant.phi, constant.c, constant.s}) {
    for (const double derivative : value.d) EXPECT_EQ(derivative, 0.0);
  }
}

TEST(Frame, SeedingGivesTheJacobianOfAPoint) {
  const Frame<double> f = make_frame(x, y, phi);
  const Vec2<double> turned = perpendicular(f.axis(local));
  const Vec2<Dual<double, 6>> p = seed<double, 6>(f, 3).point(local);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(p.x.d[k], 0.0);
  EXPECT_EQ(p.x.d[3], 1.0);
  EXPECT_EQ(p.x.d[4], 0.0);
  EXPECT_DOUBLE_EQ(p.x.d[5], turned.x);
  EXPECT_EQ(p.y.d[3], 0.0);
  EXPECT_EQ(p.y.d[4], 1.0);
  EXPECT_DOUBLE_EQ(p.y.d[5], turned.y);
}

TEST(Frame, NestedSeedingGivesTheSecondDerivative) {
  // d2(A s')/dphi2 = -A s'.
  const Frame<double> f = make_frame(x, y, phi);
  const auto p = seed<Dual<double, 3>, 3>(seed<double, 3>(f, 0), 0).point(local);
  const Vec2<double> arm = f.axis(local);
  EXPECT_DOUBLE_EQ(p.x.d[2].d[2], -arm.x);
  EXPECT_DOUBLE_EQ(p.y.d[2].d[2], -arm.y);
  EXPECT_EQ(p.x.d[0].d[2], 0.0);
}

TEST(Frame, MovingGivesVelocityAndCentripetalAcceleration) {
  const double vx = 0.9, vy = -0.2, omega = 3.5;
  const Frame<double> f = make_frame(x, y, phi);
  const Vec2<Taylor<double>> p = moving(f, vx, vy, omega).point(local);
  const Vec2<double> arm = f.axis(local), turned = perpendicular(arm);
  EXPECT_DOUBLE_EQ(p.x.d, vx + omega * turned.x);
  EXPECT_DOUBLE_EQ(p.y.d, vy + omega * turned.y);
  EXPECT_DOUBLE_EQ(p.x.dd, -omega * omega * arm.x);
  EXPECT_DOUBLE_EQ(p.y.dd, -omega * omega * arm.y);
}

}  // namespace
}  // namespace catena
