// Dual numbers: arithmetic, comparisons and the corners where a derivative is special. The derivative rules themselves
// are held against 50-digit arithmetic in high_precision_test.cpp.
#include "catena/base/dual.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace catena {
namespace {

using D = Dual<double, 2>;

TEST(Dual, ArithmeticCarriesDerivatives) {
  const D x = D::variable(3.0, 0), y = D::variable(-2.0, 1);
  const D f = x * x * y - y / x + 4.0 * x - 1.5;
  EXPECT_DOUBLE_EQ(f.v, -18.0 + 2.0 / 3.0 + 12.0 - 1.5);
  EXPECT_DOUBLE_EQ(f.d[0], 2 * 3.0 * -2.0 + (-2.0) / 9.0 + 4.0);
  EXPECT_DOUBLE_EQ(f.d[1], 9.0 - 1.0 / 3.0);
}

TEST(Dual, CompoundAssignmentIsTheOperator) {
  const D x = D::variable(1.25, 0), y = D::variable(0.5, 1);
  const auto same = [](const D& a, const D& b) { return a.v == b.v && a.d == b.d; };
  D sum = x, difference = x, product = x, quotient = x;
  EXPECT_TRUE(same(sum += y, x + y));
  EXPECT_TRUE(same(difference -= y, x - y));
  EXPECT_TRUE(same(product *= y, x * y));
  EXPECT_TRUE(same(quotient /= y, x / y));
}

TEST(Dual, ConstantsHaveNoDerivative) {
  const D c = 2.5;
  EXPECT_EQ(c.d[0], 0.0);
  EXPECT_EQ(c.d[1], 0.0);
  const Dual<D, 2> nested = 2.5;
  EXPECT_EQ(nested.v.v, 2.5);
  EXPECT_EQ(nested.d[1].v, 0.0);
}

TEST(Dual, ComparisonsSeeTheValueAlone) {
  const D a(1.0, {5.0, 0.0}), b(1.0, {-5.0, 0.0}), c(2.0, {0.0, 0.0});
  EXPECT_TRUE(a == b && a <= b && a >= b);
  EXPECT_FALSE(a < b || a > b);
  EXPECT_TRUE(a < c && c > b && a < 1.5);
}

TEST(Dual, MixedSecondDerivativesByNesting) {
  using DD = Dual<D, 2>;
  const DD x(D::variable(0.7, 0), {D(1.0), D(0.0)}), y(D::variable(1.3, 1), {D(0.0), D(1.0)});
  const DD f = sin(x * y) * exp(y);
  const double s = std::sin(0.91), c = std::cos(0.91), e = std::exp(1.3);
  EXPECT_NEAR(f.d[0].v, 1.3 * c * e, 1e-15 * 8);
  EXPECT_NEAR(f.d[0].d[0], -1.69 * s * e, 1e-15 * 8);
  EXPECT_NEAR(f.d[0].d[1], (c - 0.91 * s + 1.3 * c) * e, 1e-15 * 16);
  EXPECT_NEAR(f.d[0].d[1], f.d[1].d[0], 1e-15 * 16);
}

TEST(Dual, PowersOfZeroHaveFiniteDerivativesWherePolynomialsDo) {
  const D x = D::variable(0.0, 0);
  EXPECT_EQ(pow(x, D(0.0)).v, 1.0);
  EXPECT_EQ(pow(x, D(0.0)).d[0], 0.0);
  EXPECT_EQ(pow(x, D(1.0)).d[0], 1.0);
  EXPECT_EQ(pow(x, D(2.0)).d[0], 0.0);
  using DD = Dual<D, 2>;
  const DD xx(x, {D(1.0), D(0.0)});
  EXPECT_EQ(pow(xx, DD(2.0)).d[0].d[0], 2.0);
}

TEST(Dual, PowerVaryingExponentAtZeroKeepsTheMixedDerivative) {
  // d2(x^y)/dx dy = x^(y-1) (1 + y log x): 1/x at y = 0.
  using DD = Dual<D, 2>;
  const DD x(D::variable(4.0, 0), {D(1.0), D(0.0)}), y(D::variable(0.0, 1), {D(0.0), D(1.0)});
  EXPECT_DOUBLE_EQ(pow(x, y).d[0].d[1], 0.25);
  EXPECT_DOUBLE_EQ(pow(x, y).d[1].d[0], 0.25);
}

TEST(Dual, SingularPointsSaySo) {
  EXPECT_TRUE(std::isinf(sqrt(D::variable(0.0, 0)).d[0]));
  EXPECT_TRUE(std::isinf(log(D::variable(0.0, 0)).v));
  EXPECT_FALSE(std::isfinite((D(1.0) / D::variable(0.0, 0)).d[0]));
}

TEST(Dual, ValueOfReachesThroughNesting) {
  EXPECT_EQ(value_of(2.0), 2.0);
  EXPECT_EQ(value_of(D::variable(2.0, 1)), 2.0);
  EXPECT_EQ(value_of(Dual<D, 3>(2.0)), 2.0);
}

}  // namespace
}  // namespace catena
