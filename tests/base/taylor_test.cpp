// Second-order Taylor arithmetic: products, quotients and compositions of moving quantities against nested duals, which
// reach the same derivatives by another way. Single functions: high_precision_test.cpp.
#include "catena/base/taylor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace catena {
namespace {

using Nested = Dual<Dual<double, 1>, 1>;

/// The quadratic path f + d t + dd t^2 / 2 at t = 0 in both kinds of scalar.
Nested nested(const Taylor<double>& a) { return {Dual<double, 1>(a.f, {a.d}), {Dual<double, 1>(a.d, {a.dd})}}; }

template <class F>
void expect_same(const F& f, const Taylor<double>& a, const Taylor<double>& b) {
  const Taylor<double> found = f(a, b);
  const Nested expected = f(nested(a), nested(b));
  EXPECT_NEAR(found.f, expected.v.v, 1e-15 * (1 + std::abs(expected.v.v)));
  EXPECT_NEAR(found.d, expected.d[0].v, 1e-14 * (1 + std::abs(expected.d[0].v)));
  EXPECT_NEAR(found.dd, expected.d[0].d[0], 1e-13 * (1 + std::abs(expected.d[0].d[0])));
}

TEST(Taylor, AgreesWithNestedDuals) {
  const Taylor<double> a(0.8, -1.5, 2.25), b(1.75, 0.5, -3.0);
  expect_same([](auto x, auto y) { return x + y * 2.0 - 1.0; }, a, b);
  expect_same([](auto x, auto y) { return x * y; }, a, b);
  expect_same([](auto x, auto y) { return x / y; }, a, b);
  expect_same([](auto x, auto y) { return -x / (y * y); }, a, b);
  expect_same([](auto x, auto y) { return sin(x) * cos(y); }, a, b);
  expect_same([](auto x, auto y) { return exp(-x * y) + log(y) / sqrt(x); }, a, b);
  expect_same([](auto x, auto y) { return atan2(x, y); }, a, b);
  expect_same([](auto x, auto y) { return atan2(-x, -y) * tanh(x - y); }, a, b);
  expect_same([](auto x, auto y) { return abs(x - y) * abs(y); }, a, b);
}

TEST(Taylor, CompoundAssignmentIsTheOperator) {
  const Taylor<double> a(0.8, -1.5, 2.25), b(1.75, 0.5, -3.0);
  const auto same = [](const Taylor<double>& x, const Taylor<double>& y) {
    return x.f == y.f && x.d == y.d && x.dd == y.dd;
  };
  Taylor<double> sum = a, difference = a, product = a, quotient = a;
  EXPECT_TRUE(same(sum += b, a + b));
  EXPECT_TRUE(same(difference -= b, a - b));
  EXPECT_TRUE(same(product *= b, a * b));
  EXPECT_TRUE(same(quotient /= b, a / b));
}

TEST(Taylor, ComparisonsSeeTheValueAlone) {
  const Taylor<double> a(1.0, 5.0, 0.0), b(1.0, -5.0, 7.0);
  EXPECT_TRUE(a == b && a <= b && a >= b && a < 2.0 && a > 0.5);
  EXPECT_FALSE(a < b || a > b);
}

TEST(Taylor, OfDualsCarriesParameterDerivatives) {
  // sin(p t) at t: the derivative of its second time derivative -p^2 sin(p t) with respect to p.
  using D = Dual<double, 1>;
  const double p = 1.5, t = 0.4;
  const D parameter = D::variable(p, 0);
  const Taylor<D> f = sin(Taylor<D>(parameter) * Taylor<D>(D(t), D(1.0), D(0.0)));
  EXPECT_DOUBLE_EQ(f.dd.v, -p * p * std::sin(p * t));
  EXPECT_DOUBLE_EQ(f.dd.d[0], -2 * p * std::sin(p * t) - p * p * t * std::cos(p * t));
  EXPECT_DOUBLE_EQ(value_of(f), std::sin(p * t));
}

}  // namespace
}  // namespace catena
