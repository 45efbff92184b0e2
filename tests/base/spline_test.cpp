// Cubic splines: interpolation, continuity, end conditions, periodicity, integrals, derivatives with respect to the
// table, and the tables that are refused. Values against 50 digits: high_precision_test.cpp.
#include "catena/base/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace catena {
namespace {

using D = Dual<double, 4>;
const std::vector<double> knots = {-1.0, -0.5, 0.25, 1.0, 3.0}, values = {2.0, 0.5, -1.0, 1.5, 2.0};
constexpr SplineEnd every_end[] = {SplineEnd::natural, SplineEnd::clamped, SplineEnd::periodic};

std::string refusal(const std::vector<double>& x, const std::vector<double>& y, SplineEnd end) {
  try {
    const Spline<double> spline(x, y, end);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Spline, PassesThroughItsTableSmoothly) {
  for (const SplineEnd end : every_end) {
    const Spline<double> spline(knots, values, end);
    for (std::size_t k = 0; k < knots.size(); ++k) EXPECT_NEAR(spline.evaluate(knots[k]).f, values[k], 1e-14);
    for (std::size_t k = 1; k + 1 < knots.size(); ++k) {
      const SplineValue<double> before = spline.evaluate(std::nextafter(knots[k], -9.0)),
                                at = spline.evaluate(knots[k]);
      EXPECT_NEAR(before.d1, at.d1, 1e-13);
      EXPECT_NEAR(before.d2, at.d2, 1e-12);
    }
  }
}

TEST(Spline, DerivativesAreThoseOfTheValue) {
  for (const SplineEnd end : every_end) {
    const Spline<double> spline(knots, values, end);
    for (const double x : {-0.9, -0.3, 0.6, 2.9}) {
      // Nested duals push derivatives through the value alone.
      using D1 = Dual<double, 1>;
      const SplineValue<Dual<D1, 1>> nested = spline.evaluate(Dual<D1, 1>(D1(x, {1.0}), {D1(1.0)}));
      const SplineValue<double> plain = spline.evaluate(x);
      EXPECT_NEAR(nested.f.d[0].v, plain.d1, 1e-13);
      EXPECT_NEAR(nested.f.d[0].d[0], plain.d2, 1e-12);
      EXPECT_NEAR(nested.d1.d[0].d[0], plain.d3, 1e-12);
      EXPECT_NEAR(nested.d2.d[0].v, plain.d3, 1e-12);
      const Taylor<double> moving = spline.evaluate(Taylor<double>(x, 0.5, 2.0)).f;
      EXPECT_NEAR(moving.d, plain.d1 * 0.5, 1e-13);
      EXPECT_NEAR(moving.dd, plain.d2 * 0.25 + plain.d1 * 2.0, 1e-12);
    }
  }
}

TEST(Spline, EndConditions) {
  const Spline<double> natural(knots, values, SplineEnd::natural), clamped(knots, values, SplineEnd::clamped),
      periodic(knots, values, SplineEnd::periodic);
  for (const double end : {-1.0, 3.0}) {
    EXPECT_NEAR(natural.evaluate(end).d2, 0, 1e-13);
    EXPECT_NEAR(clamped.evaluate(end).d1, 0, 1e-14);
    EXPECT_GT(std::abs(clamped.evaluate(end).d2), 0.1);
  }
  const SplineValue<double> start = periodic.evaluate(-1.0), finish = periodic.evaluate(std::nextafter(3.0, 0.0));
  EXPECT_NEAR(start.d1, finish.d1, 1e-13);
  EXPECT_NEAR(start.d2, finish.d2, 1e-13);
}

TEST(Spline, ReproducesWhatItCan) {
  // Clamped ends suit 3 x^2 - 2 x^3 on [0, 1]: a cubic spline through its points is the cubic itself.
  const std::vector<double> x = {0, 0.2, 0.55, 1};
  std::vector<double> y;
  for (const double u : x) y.push_back(u * u * (3 - 2 * u));
  const Spline<double> spline(x, y, SplineEnd::clamped);
  for (const double u : {0.1, 0.3, 0.9, 1.0}) {
    EXPECT_NEAR(spline.evaluate(u).f, u * u * (3 - 2 * u), 1e-15);
    EXPECT_NEAR(spline.evaluate(u).d2, 6 - 12 * u, 1e-13);
    EXPECT_NEAR(spline.evaluate(u).d3, -12, 1e-12);
    EXPECT_NEAR(spline.integral(u), u * u * u - u * u * u * u / 2, 1e-15);
  }
}

TEST(Spline, PeriodicConvergesToTheSineAtFourthOrder) {
  const auto error = [](int count) {
    std::vector<double> x, y;
    for (int k = 0; k <= count; ++k) {
      x.push_back(2 * std::numbers::pi * k / count);
      y.push_back(k == count ? 0.0 : std::sin(x.back()));
    }
    const Spline<double> spline(x, y, SplineEnd::periodic);
    double worst = 0;
    for (double t = -20; t < 20; t += 0.0137) worst = std::max(worst, std::abs(spline.evaluate(t).f - std::sin(t)));
    return worst;
  };
  const double coarse = error(32), fine = error(64);
  EXPECT_LT(coarse, 2e-5);
  EXPECT_NEAR(coarse / fine, 16, 1);
}

TEST(Spline, ShortTables) {
  const Spline<double> chord(std::vector{1.0, 3.0}, std::vector{5.0, 9.0}, SplineEnd::natural);
  EXPECT_DOUBLE_EQ(chord.evaluate(1.5).f, 6.0);
  EXPECT_DOUBLE_EQ(chord.evaluate(1.5).d1, 2.0);
  const Spline<double> rise(std::vector{1.0, 3.0}, std::vector{5.0, 9.0}, SplineEnd::clamped);
  EXPECT_DOUBLE_EQ(rise.evaluate(2.0).f, 7.0);
  EXPECT_DOUBLE_EQ(rise.evaluate(2.0).d1, 3.0);
  const Spline<double> level(std::vector{1.0, 3.0}, std::vector{5.0, 5.0}, SplineEnd::periodic);
  EXPECT_DOUBLE_EQ(level.evaluate(17.3).f, 5.0);
}

TEST(Spline, GoesOnStraightBeyondItsEnds) {
  for (const SplineEnd end : {SplineEnd::natural, SplineEnd::clamped}) {
    const Spline<double> spline(knots, values, end);
    const SplineValue<double> first = spline.evaluate(-1.0), last = spline.evaluate(3.0);
    EXPECT_NEAR(spline.evaluate(-3.0).f, first.f - 2 * first.d1, 1e-13);
    EXPECT_NEAR(spline.evaluate(4.5).f, last.f + 1.5 * last.d1, 1e-13);
    EXPECT_EQ(spline.evaluate(4.5).d2, 0.0);
    EXPECT_TRUE(spline.covers(-1.0) && spline.covers(3.0));
    EXPECT_FALSE(spline.covers(-1.001) || spline.covers(3.001));
  }
}

TEST(Spline, RepeatsWhenPeriodic) {
  const Spline<double> spline(knots, values, SplineEnd::periodic);
  EXPECT_TRUE(spline.covers(1e6));
  for (const double x : {-1.0, -0.2, 2.99}) {
    for (const double cycles : {-3.0, 1.0, 250.0}) {
      EXPECT_NEAR(spline.evaluate(x + 4 * cycles).f, spline.evaluate(x).f, 1e-12);
      EXPECT_NEAR(spline.evaluate(x + 4 * cycles).d1, spline.evaluate(x).d1, 1e-11);
    }
  }
}

TEST(Spline, IntegralIsTheAntiderivative) {
  for (const SplineEnd end : every_end) {
    const Spline<double> spline(knots, values, end);
    EXPECT_EQ(spline.integral(-1.0), 0.0);
    for (const double x : {-4.0, -1.7, -0.9, 0.25, 2.0, 3.0, 3.9, 9.0}) {
      const Dual<double, 1> area = spline.integral(Dual<double, 1>(x, {1.0}));
      EXPECT_NEAR(area.d[0], spline.evaluate(x).f, 1e-12);
      // Simpson's rule is exact on each cubic: walk from the first knot in steps that end at every knot.
      double sum = 0;
      const int steps = static_cast<int>(std::abs(x + 1) * 20 + 0.5);
      const double h = (x + 1) / steps;
      for (int k = 0; k < steps; ++k) {
        const double a = -1 + k * h;
        sum += h / 6 * (spline.evaluate(a).f + 4 * spline.evaluate(a + h / 2).f + spline.evaluate(a + h).f);
      }
      EXPECT_NEAR(area.v, sum, 1e-12) << x;
    }
  }
}

TEST(Spline, DerivativesWithRespectToTheTable) {
  // Two values and two knots vary, each against central differences.
  const auto spline_at = [](double a, double b, double c, double d, SplineEnd end, double x) {
    return Spline<double>(std::vector{-1.0, -0.5 + c, 0.25, 1.0 + d, 3.0},
                          std::vector{2.0, 0.5 + a, -1.0, 1.5 + b, 2.0}, end)
        .evaluate(x);
  };
  const std::vector<D> x = {-1.0, -0.5 + D::variable(0, 2), 0.25, 1.0 + D::variable(0, 3), 3.0};
  const std::vector<D> y = {2.0, 0.5 + D::variable(0, 0), -1.0, 1.5 + D::variable(0, 1), 2.0};
  const double h = 1e-5;
  for (const SplineEnd end : every_end) {
    const Spline<D> spline(x, y, end);
    for (const double at : {-0.8, 0.0, 0.9, 2.2, 4.3}) {
      const SplineValue<D> found = spline.evaluate(D(at));
      for (std::size_t k = 0; k < 4; ++k) {
        const auto moved = [&](double by) {
          return spline_at(k == 0 ? by : 0, k == 1 ? by : 0, k == 2 ? by : 0, k == 3 ? by : 0, end, at);
        };
        EXPECT_NEAR(found.f.d[k], (moved(h).f - moved(-h).f) / (2 * h), 2e-8);
        EXPECT_NEAR(found.d2.d[k], (moved(h).d2 - moved(-h).d2) / (2 * h), 2e-6);
      }
    }
  }
}

TEST(Spline, DerivativeWithRespectToThePeriod) {
  const std::vector<D> x = {0.0, 1.0, 2.0 + D::variable(0, 0)}, y = {0.0, 1.0, 0.0};
  const Spline<D> spline(x, y, SplineEnd::periodic);
  const auto at = [](double period) {
    return Spline<double>(std::vector{0.0, 1.0, period}, std::vector{0.0, 1.0, 0.0}, SplineEnd::periodic)
        .evaluate(7.3)
        .f;
  };
  EXPECT_NEAR(spline.evaluate(D(7.3)).f.d[0], (at(2 + 1e-5) - at(2 - 1e-5)) / 2e-5, 1e-8);
}

TEST(Spline, RefusesBadTablesByEntry) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal({0, 1}, {0}, SplineEnd::natural), "spline: 2 knots, but 1 values");
  EXPECT_EQ(refusal({0}, {0}, SplineEnd::natural), "spline: needs at least 2 points, has 1");
  EXPECT_EQ(refusal({}, {}, SplineEnd::periodic), "spline: needs at least 2 points, has 0");
  EXPECT_EQ(refusal({0, 0.5, 0.5}, {0, 1, 2}, SplineEnd::clamped),
            "spline: knots must increase, but knot[2] = 0.5 follows 0.5");
  EXPECT_EQ(refusal({0, nan}, {0, 1}, SplineEnd::natural), "spline: knot[1] is not finite");
  EXPECT_EQ(refusal({0, 1}, {nan, 1}, SplineEnd::natural), "spline: value[0] is not finite");
  EXPECT_EQ(refusal({0, 1, 2}, {0.5, 1, 0.6}, SplineEnd::periodic),
            "spline: periodic, but it starts at 0.5 and ends at 0.6");
}

}  // namespace
}  // namespace catena
