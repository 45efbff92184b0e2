// Functions of time: closed forms, derivatives, breakpoints, combinations, derivatives with respect to design
// parameters, and the data that are refused.
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

template <class Make>
std::string refusal(const Make& make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
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
  EXPECT_DOUBLE_EQ(a.f, b.f);
  EXPECT_DOUBLE_EQ(a.d, b.d);
  EXPECT_DOUBLE_EQ(a.dd, b.dd);
}

TEST(TimeFunction, DerivativesAreThoseOfTheValue) {
  for (const F& f : one_of_each()) expect_derivatives_match(f);
}

TEST(TimeFunction, SumsAndProductsOfEverything) {
  const std::vector<F> kinds = one_of_each();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = 0; j < kinds.size(); ++j) {
      SCOPED_TRACE(testing::Message() << i << ", " << j);
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
  const F rounded = F::sum({F::product({F::step(0.3, 1, 0, 0.49, 3), F(2)}), F(1)});
  EXPECT_EQ(rounded.evaluate(3 * 0.1, Side::before).dd, 0);
  EXPECT_NEAR(rounded.evaluate(3 * 0.1, Side::after).dd, 12, 1e-12);
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

/// Derivatives with respect to four design parameters against central differences of functions of plain numbers.
template <class MakeDual, class MakePlain>
void expect_design_derivatives(const MakeDual& dual, const MakePlain& plain, const std::vector<double>& p) {
  std::vector<D> parameters;
  for (std::size_t k = 0; k < 4; ++k) parameters.push_back(D::variable(p[k], static_cast<int>(k)));
  const FD f = dual(parameters);
  const double h = 1e-5;
  for (const double t : {0.11, 0.77, 1.37, 1.9}) {
    const Taylor<D> found = f.evaluate(t);
    for (std::size_t k = 0; k < 4; ++k) {
      SCOPED_TRACE(testing::Message() << "parameter " << k << " at " << t);
      std::vector<double> more = p, less = p;
      more[k] += h;
      less[k] -= h;
      const Taylor<double> difference = (plain(more).evaluate(t) - plain(less).evaluate(t)) / Taylor<double>(2 * h);
      EXPECT_NEAR(found.f.d[k], difference.f, 1e-7);
      EXPECT_NEAR(found.d.d[k], difference.d, 1e-6);
      EXPECT_NEAR(found.dd.d[k], difference.dd, 1e-5);
    }
    const Taylor<double> value = plain(p).evaluate(t);
    expect_equal({found.f.v, found.d.v, found.dd.v}, value);
  }
}

TEST(TimeFunction, DesignDerivatives) {
  expect_design_derivatives([](const std::vector<D>& p) { return FD::polynomial(p); },
                            [](const Table& p) { return F::polynomial(p); }, {1, -2, 0.5, 0.25});
  expect_design_derivatives([](const std::vector<D>& p) { return FD::harmonic(p[0], p[1], p[2], p[3]); },
                            [](const Table& p) { return F::harmonic(p[0], p[1], p[2], p[3]); }, {1.5, 2, 0.25, 0.5});
  for (const int order : {3, 5}) {
    expect_design_derivatives([&](const std::vector<D>& p) { return FD::step(p[0], p[1], p[2], p[3], order); },
                              [&](const Table& p) { return F::step(p[0], p[1], p[2], p[3], order); },
                              {0.2, 1.6, -1, 3});
  }
  for (const SplineEnd end : {SplineEnd::natural, SplineEnd::clamped, SplineEnd::periodic}) {
    expect_design_derivatives(
        [&](const std::vector<D>& p) {
          const std::vector<D> t = {0, 0.5 + p[0], 1.2, 2.0 + p[1]}, value = {1.0, p[2], p[3], 1.0};
          return FD::spline(t, value, end);
        },
        [&](const Table& p) {
          return table({0, 0.5 + p[0], 1.2, 2.0 + p[1]}, {1, p[2], p[3], 1}, end);
        },
        {0, 0, 2, -1});
  }
  expect_design_derivatives(
      [](const std::vector<D>& p) {
        return FD::product({FD::harmonic(p[0], p[1]), FD::sum({FD(p[2]), FD::step(0.0, p[3], 0.0, 1.0, 5)})});
      },
      [](const Table& p) {
        return F::product({F::harmonic(p[0], p[1]), F::sum({F(p[2]), F::step(0, p[3], 0, 1, 5)})});
      },
      {1.5, 2, 0.25, 2.5});
}

TEST(TimeFunction, CallbacksHaveNoDesignDerivatives) {
  const FD f = FD::custom([](double t) { return Taylor<double>(t * t, 2 * t, 2); });
  const Taylor<D> at = f.evaluate(3);
  EXPECT_EQ(at.f.v, 9);
  EXPECT_EQ(at.d.v, 6);
  EXPECT_EQ(at.dd.v, 2);
  EXPECT_EQ(at.f.d[0], 0);
}

TEST(TimeFunction, RefusesWhatIsNoFunction) {
  const double nan = std::nan("");
  EXPECT_EQ(refusal([] { return F::step(1, 1, 0, 1, 3); }), "step: t1 = 1 must be later than t0 = 1");
  EXPECT_EQ(refusal([] { return F::step(2, 1.5, 0, 1, 3); }), "step: t1 = 1.5 must be later than t0 = 2");
  EXPECT_EQ(refusal([] { return F::step(0, 1, 0, 1, 4); }), "step: order must be 3 or 5, is 4");
  EXPECT_EQ(refusal([] { return F::step(0, infinity, 0, 1, 5); }), "step: t1 is not finite");
  EXPECT_EQ(refusal([&] { return F::harmonic(1, nan); }), "harmonic: omega is not finite");
  EXPECT_EQ(refusal([&] { return polynomial({1, nan}); }), "polynomial: coefficient[1] is not finite");
  EXPECT_EQ(refusal([] {
              return table({0, 1, 1}, {0, 1, 2}, SplineEnd::natural);
            }),
            "spline: knots must increase, but knot[2] = 1 follows 1");
  EXPECT_EQ(refusal([] {
              return table({0, 1}, {0, 1}, SplineEnd::periodic);
            }),
            "spline: periodic, but it starts at 0 and ends at 1");
  EXPECT_EQ(refusal([] { return F::sum({}); }), "sum: needs at least one term");
  EXPECT_EQ(refusal([] { return F::product({}); }), "product: needs at least one factor");
  EXPECT_EQ(refusal([] { return F::custom({}); }), "custom function of time: the callback is empty");
  EXPECT_EQ(refusal([] {
              return F::custom([](double) { return Taylor<double>(); }, {1, 0});
            }),
            "custom function of time: breakpoints must increase");
}

}  // namespace
}  // namespace catena
