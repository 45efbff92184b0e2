// Functions of time: closed forms, derivatives, breakpoints, combinations. Derivatives with respect to design
// parameters and the data that are refused: time_function_design_test.cpp.
#include "catena/base/time_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace catena {
namespace {

using F = TimeFunction<double>;
using D = Dual<double, 4>;
using FD = TimeFunction<D>;
using Table = std::vector<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

F polynomial(const Table& c) { return F::polynomial(c); }
F table(const Table& t, const Table& value, SplineEnd end) { return F::spline(t, value, end); }

F ramp() { return F::step(0.5, 2.5, -1.0, 3.0, 5); }
F jerky() { return F::step(-0.25, 1.5, 2.0, 0.5, 3); }
F wave() { return F::harmonic(1.5, 2.0, 0.25, 0.5); }
F saw() { return table({0.0, 0.3, 1.0, 1.25}, {1.0, 2.0, 0.5, 1.0}, SplineEnd::periodic); }
F square_root() {
  return F::custom([](double t) { return sqrt(Taylor<double>(t + 30, 1.0, 0.0)); }, {1.0, 7.0});
}
std::vector<F> one_of_each() {
  return {F(2.5),
          polynomial({1.0, -0.5, 0.25, 0.125}),
          wave(),
          jerky(),
          ramp(),
          saw(),
          table({-1.0, 0.0, 2.0, 4.0}, {0.0, 1.0, -1.0, 0.5}, SplineEnd::natural),
          table({-1.0, 0.0, 2.0, 4.0}, {0.0, 1.0, -1.0, 0.5}, SplineEnd::clamped),
          square_root()};
}

void expect_derivatives_match(const F& f) {
  const double h = 1e-4;
  for (const double t : {-0.83, -0.1, 0.11, 0.77, 1.37, 1.9, 3.3}) {
    // Five points and the smoothness between breakpoints: the error is of order h^4.
    const auto slope = [&](auto part) {
      return (8 * (part(t + h) - part(t - h)) - (part(t + 2 * h) - part(t - 2 * h))) / (12 * h);
    };
    const Taylor<double> at = f.evaluate(t);
    EXPECT_NEAR(at.d, slope([&](double x) { return f.evaluate(x).f; }), 1e-10 * (1 + std::abs(at.f) + std::abs(at.d)))
        << t;
    EXPECT_NEAR(at.dd, slope([&](double x) { return f.evaluate(x).d; }), 1e-10 * (1 + std::abs(at.d) + std::abs(at.dd)))
        << t;
  }
}

void expect_equal(const Taylor<double>& a, const Taylor<double>& b) {
  EXPECT_NEAR(a.f, b.f, 1e-14 * (1 + std::abs(b.f)));
  EXPECT_NEAR(a.d, b.d, 1e-14 * (1 + std::abs(b.d)));
  EXPECT_NEAR(a.dd, b.dd, 1e-14 * (1 + std::abs(b.dd)));
}

TEST(TimeFunction, DerivativesAreThoseOfTheValue) {
  for (const F& f : one_of_each()) expect_derivatives_match(f);
}

TEST(TimeFunction, SumsAndProductsOfEverything) {
  const std::vector<F> kinds = one_of_each();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = 0; j < kinds.size(); ++j) {
      SCOPED_TRACE(::testing::Message() << i << ", " << j);
      for (const double t : {-0.83, 0.4, 2.9}) {
        const Taylor<double> a = kinds[i].evaluate(t), b = kinds[j].evaluate(t);
        expect_equal(F::sum({kinds[i], kinds[j]}).evaluate(t), a + b);
        expect_equal(F::product({kinds[i], kinds[j]}).evaluate(t), a * b);
      }
      expect_derivatives_match(F::product({F::sum({kinds[i], F(0.75)}), kinds[j]}));
    }
  }
  const Taylor<double> three = F::product({wave(), ramp(), wave()}).evaluate(1.0);
  expect_equal(three, wave().evaluate(1.0) * ramp().evaluate(1.0) * wave().evaluate(1.0));
}

TEST(TimeFunction, ClosedForms) {
  expect_equal(F().evaluate(7), {0, 0, 0});
  expect_equal(F(2.5).evaluate(-1e9), {2.5, 0, 0});
  expect_equal(polynomial({1, -2, 3}).evaluate(2), {9, 10, 6});
  const double angle = 2.0 * 0.7 + 0.25;
  expect_equal(wave().evaluate(0.7), {0.5 + 1.5 * std::sin(angle), 3 * std::cos(angle), -6 * std::sin(angle)});
  expect_equal(F::step(1, 3, 10, 14, 3).evaluate(1.5),
               {10 + 4 * (3. / 16 - 2. / 64), 4 * (6. / 4 - 6. / 16) / 2, 4 * (6. - 3) / 4});
  expect_equal(F::step(1, 3, 10, 14, 5).evaluate(2), {12, 4 * (30 - 60 + 30) / 16. / 2 + 3.75, 0});
  expect_equal(square_root().evaluate(6), {6, 1. / 12, -1. / 864});
}

TEST(TimeFunction, StepsEndExactly) {
  for (const int order : {3, 5}) {
    const F step = F::step(0.1, 0.3, 0.7, -1.1, order);
    expect_equal(step.evaluate(-5), {0.7, 0, 0});
    expect_equal(step.evaluate(0.1, Side::before), {0.7, 0, 0});
    expect_equal(step.evaluate(0.3), {-1.1, 0, 0});
    expect_equal(step.evaluate(5), {-1.1, 0, 0});
    EXPECT_NEAR(step.evaluate(0.1).f, 0.7, 1e-15);
    EXPECT_NEAR(step.evaluate(0.3, Side::before).f, -1.1, 4e-15);
    EXPECT_NEAR(step.evaluate(0.3, Side::before).d, 0, 1e-12);
  }
}

TEST(TimeFunction, SidesOfAStepDifferInTheSecondDerivativeOfOrder3Alone) {
  const F third = F::step(1, 3, 0, 4, 3), fifth = F::step(1, 3, 0, 4, 5);
  EXPECT_EQ(third.evaluate(1, Side::before).dd, 0);
  EXPECT_DOUBLE_EQ(third.evaluate(1, Side::after).dd, 6);
  EXPECT_DOUBLE_EQ(third.evaluate(3, Side::before).dd, -6);
  EXPECT_EQ(third.evaluate(3, Side::after).dd, 0);
  for (const Side side : {Side::before, Side::after}) {
    EXPECT_NEAR(fifth.evaluate(1, side).dd, 0, 1e-14);
    EXPECT_NEAR(fifth.evaluate(3, side).dd, 0, 1e-14);
  }
  // Times that are multiples of a step meet a breakpoint up to rounding; combinations pass the side on.
  const F rise = F::step(0.3, 1, 0, 0.49, 3);
  for (const F& f : {F::sum({F::product({rise, F(2)}), F(1)}), F::sum({F(1), F::product({F(2), rise})})}) {
    EXPECT_EQ(f.evaluate(3 * 0.1, Side::before).dd, 0);
    EXPECT_NEAR(f.evaluate(3 * 0.1, Side::after).dd, 12, 1e-12);
  }
}

TEST(TimeFunction, TablesEndAndSaySo) {
  const F f = table({0.0, 0.1, 0.3}, {1.0, 2.0, 4.0}, SplineEnd::clamped);
  EXPECT_EQ(f.domain().first, 0.0);
  EXPECT_EQ(f.domain().last, 0.3);
  // 3 * 0.1 is greater than 0.3 by one rounding.
  EXPECT_GT(3 * 0.1, 0.3);
  expect_equal(f.evaluate(3 * 0.1), f.evaluate(0.3));
  try {
    f.evaluate(0.31);
    FAIL() << "evaluated outside the table";
  } catch (const OutsideTable& error) {
    EXPECT_EQ(error.t, 0.31);
    EXPECT_EQ(error.first, 0.0);
    EXPECT_EQ(error.last, 0.3);
    EXPECT_EQ(
        std::string(error.what()),
        "time 0.31 s lies outside the spline's table, which covers 0 s to 0.3 s; extend the table or make it periodic");
  }
  EXPECT_THROW(f.evaluate(-1e-6), OutsideTable);
  EXPECT_THROW(f.evaluate(std::nan("")), OutsideTable);
  const F both = F::product({f, table({0.2, 0.25, 9.0}, {0, 1, 0}, SplineEnd::natural), wave(), saw()});
  EXPECT_EQ(both.domain().first, 0.2);
  EXPECT_EQ(both.domain().last, 0.3);
  EXPECT_EQ(wave().domain().last, infinity);
  EXPECT_EQ(saw().domain().first, -infinity);
}

TEST(TimeFunction, Breakpoints) {
  EXPECT_EQ(F::sum({F(1), wave(), polynomial({0, 1})}).breakpoints(-1e9, 1e9), Table{});
  EXPECT_EQ(ramp().breakpoints(-10, 10), (Table{0.5, 2.5}));
  EXPECT_EQ(ramp().breakpoints(0.5, 2.5), Table{});
  EXPECT_EQ(ramp().breakpoints(0.4, 1.0), Table{0.5});
  EXPECT_EQ(square_root().breakpoints(0, 10), (Table{1.0, 7.0}));
  EXPECT_EQ(table({0.0, 1.0, 2.5, 3.0}, {0, 1, 0, 2}, SplineEnd::natural).breakpoints(0, 3), (Table{1.0, 2.5}));
  EXPECT_EQ(F::product({ramp(), jerky()}).breakpoints(-1, 3), (Table{-0.25, 0.5, 1.5, 2.5}));
  EXPECT_EQ(ramp().next_breakpoint(0.5), 2.5);
  EXPECT_EQ(ramp().next_breakpoint(2.5), infinity);
}

TEST(TimeFunction, BreakpointsOfPeriodicTablesRepeat) {
  // The seam at 1.25 counts once a period: the third derivative jumps there too.
  EXPECT_EQ(saw().breakpoints(-1.25, 2.5), (Table{-0.95, -0.25, 0.0, 0.3, 1.0, 1.25, 1.55, 2.25}));
  // A period that is no binary fraction, over many periods: every knot exactly once, each close to its place.
  const F fine = table({0.0, 0.03, 0.1}, {0, 1, 0}, SplineEnd::periodic);
  const Table breaks = fine.breakpoints(-0.05, 100.05);
  ASSERT_EQ(breaks.size(), 2001 + 1);
  for (std::size_t k = 1; k < breaks.size(); ++k) EXPECT_GT(breaks[k] - breaks[k - 1], 0.0299);
  EXPECT_NEAR(breaks.back(), 100.03, 1e-12);
  for (const double t : {1e15, 1e300, -infinity, infinity, std::nan("")}) EXPECT_EQ(fine.next_breakpoint(t), infinity);
}

TEST(TimeFunction, OneInstantIsOneBreakpoint) {
  const F f = F::sum({F::step(0.1 * 3, 1, 0, 1, 3), F::step(0.3, 2, 0, 1, 5)});
  EXPECT_EQ(f.breakpoints(0, 1.5), (Table{0.3, 1.0}));
  EXPECT_EQ(f.breakpoints(0.1 * 3, 1.5), Table{1.0});
  EXPECT_EQ(f.breakpoints(0.0, 0.1 * 3), Table{});
}

TEST(TimeFunction, ConstancyIsSeen) {
  EXPECT_TRUE(F().is_constant() && F(3).is_constant() && polynomial({2, 0, 0}).is_constant() &&
              polynomial({}).is_constant());
  EXPECT_TRUE(F::harmonic(0, 3, 1, 2).is_constant() && F::step(0, 1, 2, 2, 3).is_constant());
  const F folded = F::product({F(3), F::sum({F(1), polynomial({0.5})})});
  EXPECT_TRUE(folded.is_constant());
  EXPECT_EQ(folded.evaluate(1).f, 4.5);
  EXPECT_EQ(F::harmonic(0, 3, 1, 2).evaluate(5).f, 2);
  for (const F& f : {polynomial({0, 1}), wave(), ramp(), saw(), square_root(), F::sum({F(1), wave()})}) {
    EXPECT_FALSE(f.is_constant());
  }
  // An amplitude of zero that a design parameter may change is no constant.
  EXPECT_FALSE(FD::harmonic(D::variable(0, 0), 3, 0, 0).is_constant());
}

TEST(TimeFunction, CopiesShareAndStayValid) {
  F f = wave();
  const F copy = f;
  f = F(1);
  EXPECT_DOUBLE_EQ(copy.evaluate(0.7).f, wave().evaluate(0.7).f);
  EXPECT_TRUE(f.is_constant());
}

}  // namespace
}  // namespace catena
