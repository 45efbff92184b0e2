// Functions of time beyond the ends of tables, and pieces that go on: against the Taylor polynomial of the piece.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "catena/base/time_function.hpp"

namespace catena::testing {
namespace {

using Function = TimeFunction<double>;

void expect_near(const Taylor<double>& a, const Taylor<double>& b, double tolerance) {
  EXPECT_NEAR(a.f, b.f, tolerance);
  EXPECT_NEAR(a.d, b.d, tolerance);
  EXPECT_NEAR(a.dd, b.dd, tolerance);
}

// A cubic is its own Taylor polynomial: two values of the second derivative within the piece tell the third.
Taylor<double> taylor(const Function& f, double within, double elsewhere_within, double t) {
  const Taylor<double> at = f.evaluate(within);
  const double third = (f.evaluate(elsewhere_within).dd - at.dd) / (elsewhere_within - within), h = t - within;
  return {at.f + h * (at.d + h * (at.dd / 2 + h * third / 6)), at.d + h * (at.dd + h * third / 2), at.dd + h * third};
}

TEST(TimeFunctionPieces, GoOnAsTheyAre) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1), gap(0.2, 1);
  for (int k = 0; k < 200; ++k) {
    std::vector<double> t{number(random)}, value{number(random)};
    for (int n = 0; n < 4; ++n) {
      t.push_back(t.back() + gap(random));
      value.push_back(number(random));
    }
    if (k % 3 == 2) value.back() = value.front();
    const Function f = Function::spline(t, value, static_cast<SplineEnd>(k % 3), k % 2 ? Beyond::error : Beyond::hold);
    for (std::size_t n = 0; n + 1 < t.size(); ++n) {
      const double far = t[n] - 3 + 0.7 * k / 20, a = t[n] + 0.3 * (t[n + 1] - t[n]),
                   b = t[n] + 0.8 * (t[n + 1] - t[n]);
      const Taylor<double> right = taylor(f, a, b, far);
      const double size = 1e-10 * (1 + std::abs(right.f) + std::abs(right.d) + std::abs(right.dd));
      expect_near(f.continue_from(t[n], Side::after, far), right, size);
      expect_near(f.continue_from(t[n + 1], Side::before, far), right, size);
      expect_near(f.continue_from(a, Side::before, far), right, size);
    }
  }
  const Function step = Function::step(0, 2, 1, 3, 3);
  expect_near(step.continue_from(0, Side::before, 1), {1, 0, 0}, 0);
  expect_near(step.continue_from(2, Side::after, 1), {3, 0, 0}, 0);
  // 1 + 2 (3 u^2 - 2 u^3), u = -1/2
  expect_near(step.continue_from(0, Side::after, -1), {3, -4.5, 6}, 1e-14);
  const Function own = Function::custom([](double t) { return Taylor<double>(t * t, 2 * t, 2); }, {}, {1, 2});
  expect_near(own.continue_from(1, Side::after, 0.5), {0.25, 1, 2}, 1e-15);
  EXPECT_THROW(own.evaluate(0.5), OutsideTable);
  EXPECT_TRUE(Function::sum({own, step}).has_callback());
  EXPECT_FALSE(Function::product({step, step}).has_callback());
  EXPECT_EQ(Function::sum({own, step}).domain().first, 1);
}

TEST(TimeFunctionBeyond, HoldsOrGoesOn) {
  const std::vector<double> t{0, 1, 2}, value{0, 1, 4};
  const Function ends = Function::spline(t, value, SplineEnd::natural);
  const Function holds = Function::spline(t, value, SplineEnd::natural, Beyond::hold);
  const Function line = Function::spline(t, value, SplineEnd::natural, Beyond::line);
  for (const double s : {0.0, 0.3, 1.0, 1.9}) {
    expect_near(holds.evaluate(s), ends.evaluate(s), 0);
    expect_near(line.evaluate(s), ends.evaluate(s), 0);
  }
  const double slope = ends.evaluate(2).d;
  expect_near(holds.evaluate(5), {4, 0, 0}, 0);
  expect_near(holds.evaluate(-5), {0, 0, 0}, 0);
  expect_near(line.evaluate(5), {4 + 3 * slope, slope, 0}, 1e-14);
  // At the end itself the side tells.
  expect_near(holds.evaluate(2, Side::after), {4, 0, 0}, 0);
  EXPECT_NEAR(holds.evaluate(2, Side::before).d, slope, 1e-14);
  EXPECT_EQ(holds.domain().last, std::numeric_limits<double>::infinity());
  EXPECT_EQ(holds.next_breakpoint(1.5), 2);
  EXPECT_THROW(ends.evaluate(2.1), OutsideTable);
  EXPECT_THROW(holds.evaluate(std::nan("")), OutsideTable);
}

TEST(TimeFunctionBeyond, PartsMustShareAnInstant) {
  const std::vector<double> early{0, 1}, late{2, 3}, value{0, 1};
  const Function a = Function::spline(early, value, SplineEnd::natural);
  const Function b = Function::spline(late, value, SplineEnd::natural);
  EXPECT_THROW(Function::sum({a, b}), std::invalid_argument);
  EXPECT_THROW(Function::product({a, b}), std::invalid_argument);
  EXPECT_NO_THROW(Function::sum({a, Function::spline(late, value, SplineEnd::natural, Beyond::hold)}));
  EXPECT_THROW(Function::custom([](double) { return Taylor<double>(); }, {}, {1, 0}), std::invalid_argument);
  EXPECT_THROW(Function::custom([](double) { return Taylor<double>(); }, {std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace catena::testing
