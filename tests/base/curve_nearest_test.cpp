// The nearest point of a curve: closed forms, a fine scan, ends, and the derivatives that the parameter carries.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "analysis/sanitized.hpp"
#include "base/example_curves.hpp"
#include "catena/base/curve.hpp"

namespace catena {
namespace {

using namespace test_curves;

TEST(CurveNearest, InClosedForm) {
  EXPECT_NEAR(C::circle({0.5, -0.25}, 1.5).nearest({0.5, 7}), pi / 2, 1e-15);
  EXPECT_TRUE(std::isfinite(C::circle({0.5, -0.25}, 1.5).nearest({0.5, -0.25})));
  EXPECT_NEAR(C::line({1, 2}, {3, -4}).nearest({1 + 0.6 * 7 + 0.8, 2 - 0.8 * 7 + 0.6}), 7, 1e-14);
}

TEST(CurveNearest, BeatsAFineScan) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> place(-2.5, 4.5);
  for (const C& curve : {open_curve(), closed_curve(), cam()}) {
    const int scanned = testing::size_of_test(20000, 2000);
    for (int trial = 0; trial < 60; ++trial) {
      const Vec2<double> point{place(generator), place(generator)};
      const double s = curve.nearest(point), found = norm(curve.evaluate(s).p - point);
      double least = infinity;
      for (int k = 0; k <= scanned; ++k) {
        const double at = curve.first() + (curve.last() - curve.first()) * k / scanned;
        least = std::min(least, norm(curve.evaluate(at).p - point));
      }
      EXPECT_LE(found, least + 1e-13);
      EXPECT_GE(s, curve.first() - 1e-9);
      EXPECT_LE(s, curve.last() + 1e-9);
      const CurvePoint<double> foot = curve.evaluate(s);
      const bool at_end = !curve.periodic() && (s == curve.first() || s == curve.last());
      EXPECT_TRUE(at_end || std::abs(dot(foot.tangent(), foot.p - point)) < 1e-13);
    }
  }
}

TEST(CurveNearest, OfAPointOnTheCurveIsItself) {
  for (const C& curve : {open_curve(), closed_curve(), cam()}) {
    for (double part = 0.01; part < 1; part += 0.07) {
      const double s = curve.first() + part * (curve.last() - curve.first());
      EXPECT_NEAR(curve.nearest(curve.evaluate(s).p), s, 1e-13);
    }
  }
}

TEST(CurveNearest, AtTheEndsOfAnOpenCurve) {
  EXPECT_EQ(open_curve().nearest({-1, -0.7}), 0.0);
  EXPECT_EQ(open_curve().nearest({4.6, 0.1}), open_curve().last());
}

TEST(CurveNearest, ParameterCarriesDerivatives) {
  // With respect to the point (2), to a point of the table and to a radius, against central differences.
  const double h = 1e-5;
  const auto open = [](double x, double y, double a) {
    return through({{0, 0}, {1, 0.5 + a}, {1.5, 2}, {3, 2.5}, {4, 1}}, SplineEnd::natural).nearest({x, y});
  };
  const std::vector<Vec2<D>> table = {{0.0, 0.0}, {1.0, 0.5 + D::variable(0, 2)}, {1.5, 2.0}, {3.0, 2.5}, {4.0, 1.0}};
  const Vec2<D> point{D::variable(0.6, 0), D::variable(1.3, 1)};
  const D s = Curve<D>::spline(table, SplineEnd::natural).nearest(point);
  EXPECT_NEAR(s.v, open(0.6, 1.3, 0), 1e-14);
  EXPECT_NEAR(s.d[0], (open(0.6 + h, 1.3, 0) - open(0.6 - h, 1.3, 0)) / (2 * h), 1e-8);
  EXPECT_NEAR(s.d[1], (open(0.6, 1.3 + h, 0) - open(0.6, 1.3 - h, 0)) / (2 * h), 1e-8);
  EXPECT_NEAR(s.d[2], (open(0.6, 1.3, h) - open(0.6, 1.3, -h)) / (2 * h), 1e-8);
  EXPECT_EQ(s.d[3], 0);

  const auto length = [&](double a) { return open(4.6, 0.1, a); };
  const D end = Curve<D>::spline(table, SplineEnd::natural).nearest({D(4.6), D(0.1)});
  EXPECT_NEAR(end.d[2], (length(h) - length(-h)) / (2 * h), 1e-8);

  const D angle = Curve<D>::circle({0.0, 0.0}, 1.0).nearest({D::variable(3, 0), D::variable(4, 1)});
  EXPECT_NEAR(angle.d[0], -4. / 25, 1e-15);
  EXPECT_NEAR(angle.d[1], 3. / 25, 1e-15);
}

}  // namespace
}  // namespace catena
