// Curves: closed forms, derivatives for every scalar, parameter ranges, nearest points, refused data.
#include "catena/base/curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/example_curves.hpp"

namespace catena {
namespace {

using namespace test_curves;

std::vector<C> every_curve() {
  return {C::circle({0.5, -0.25}, 1.5), C::line({1, 2}, {3, -4}), open_curve(), closed_curve(), cam()};
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

void expect_near(const Vec2<double>& a, const Vec2<double>& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(Curve, DerivativesAreThoseOfThePosition) {
  using D1 = Dual<double, 1>;
  using D2 = Dual<D1, 1>;
  using D3 = Dual<D2, 1>;
  for (const C& curve : every_curve()) {
    for (const double s : {-0.8, 0.1, 1.3, 2.6, 5.9}) {
      const CurvePoint<double> plain = curve.evaluate(s);
      const CurvePoint<D3> nested = curve.evaluate(D3(D2(D1(s, {1.0}), {D1(1.0)}), {D2(1.0)}));
      expect_near(plain.p, {nested.p.x.v.v.v, nested.p.y.v.v.v}, 1e-15);
      expect_near(plain.d1, {nested.p.x.d[0].v.v, nested.p.y.d[0].v.v}, 1e-13);
      expect_near(plain.d2, {nested.p.x.d[0].d[0].v, nested.p.y.d[0].d[0].v}, 1e-13);
      expect_near(plain.d3, {nested.p.x.d[0].d[0].d[0], nested.p.y.d[0].d[0].d[0]}, 1e-12);
    }
  }
}

TEST(Curve, AMovingParameterGivesVelocityAndAcceleration) {
  for (const C& curve : every_curve()) {
    const double s = 0.9, rate = 1.5, change = -0.75;
    const CurvePoint<double> at = curve.evaluate(s);
    const CurvePoint<Taylor<double>> moving = curve.evaluate(Taylor<double>(s, rate, change));
    expect_near({moving.p.x.d, moving.p.y.d}, rate * at.d1, 1e-14);
    expect_near({moving.p.x.dd, moving.p.y.dd}, rate * rate * at.d2 + change * at.d1, 1e-13);
    expect_near({moving.d1.x.d, moving.d1.y.d}, rate * at.d2, 1e-13);
  }
}

TEST(Curve, Circle) {
  const C circle = C::circle({0.5, -0.25}, 1.5);
  const CurvePoint<double> at = circle.evaluate(0.7);
  expect_near(at.p, {0.5 + 1.5 * std::cos(0.7), -0.25 + 1.5 * std::sin(0.7)}, 1e-15);
  expect_near(at.tangent(), {-std::sin(0.7), std::cos(0.7)}, 1e-15);
  expect_near(at.normal(), {-std::cos(0.7), -std::sin(0.7)}, 1e-15);
  EXPECT_NEAR(at.curvature(), 1 / 1.5, 1e-15);
  EXPECT_TRUE(circle.periodic());
  EXPECT_EQ(circle.last() - circle.first(), 2 * pi);
  EXPECT_TRUE(circle.knots().empty());
}

TEST(Curve, LineIsInArcLength) {
  const C line = C::line({1, 2}, {3, -4});
  const CurvePoint<double> at = line.evaluate(5.0);
  expect_near(at.p, {4, -2}, 1e-15);
  expect_near(at.d1, {0.6, -0.8}, 1e-16);
  EXPECT_EQ(at.curvature(), 0);
  EXPECT_FALSE(line.periodic());
  EXPECT_EQ(line.first(), -infinity);
  EXPECT_EQ(line.last(), infinity);
}

TEST(Curve, SplinesPassThroughTheirPointsInOrder) {
  const Points points = {{1, 0}, {0.25, 1}, {-1, 0.3}, {-0.4, -0.8}};
  for (const SplineEnd end : {SplineEnd::natural, SplineEnd::periodic}) {
    const C curve = through(points, end);
    double s = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (k > 0) s += norm(points[k] - points[k - 1]);
      expect_near(curve.evaluate(s).p, points[k], 1e-15);
      EXPECT_NEAR(curve.knots()[k], s, 1e-15);
    }
    EXPECT_EQ(curve.periodic(), end == SplineEnd::periodic);
    EXPECT_NEAR(curve.last(), s + (curve.periodic() ? norm(points.front() - points.back()) : 0), 1e-15);
  }
}

TEST(Curve, ClosedCurvesAreSmoothAtTheSeam) {
  for (const C& curve : {closed_curve(), cam()}) {
    const CurvePoint<double> start = curve.evaluate(curve.first()),
                             finish = curve.evaluate(std::nextafter(curve.last(), 0.0));
    expect_near(start.p, finish.p, 1e-14);
    expect_near(start.d1, finish.d1, 1e-13);
    expect_near(start.d2, finish.d2, 1e-12);
    const double period = curve.last() - curve.first();
    expect_near(curve.evaluate(0.3 - 7 * period).p, curve.evaluate(0.3).p, 1e-13);
    expect_near(curve.evaluate(0.3 + 40 * period).p, curve.evaluate(0.3).p, 1e-12);
  }
}

TEST(Curve, RepeatingTheFirstPointChangesNothing) {
  const C closed = through({{1, 0}, {0.25, 1}, {-1, 0.3}, {-0.4, -0.8}, {1, 0}}, SplineEnd::periodic);
  EXPECT_EQ(closed.last(), closed_curve().last());
  EXPECT_EQ(closed.evaluate(2.2).p, closed_curve().evaluate(2.2).p);
  const C turn = egg({-0.5, 0.5, 1.7, 3.0, 4.4, -0.5 + 2 * pi}, {1.0, 1.3, 1.1, 0.9, 0.95, 1.0});
  expect_near(turn.evaluate(5.5).p, cam().evaluate(5.5).p, 1e-15);
}

TEST(Curve, PolarInterpolatesRadii) {
  const std::vector<double> angles = {-0.5, 0.5, 1.7, 3.0, 4.4}, radii = {1.0, 1.3, 1.1, 0.9, 0.95};
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const Vec2<double> p = cam().evaluate(angles[k]).p;
    EXPECT_NEAR(norm(p), radii[k], 1e-15);
    EXPECT_NEAR(std::remainder(std::atan2(p.y, p.x) - angles[k], 2 * pi), 0, 1e-15);
  }
  const C round = egg({0, 2, 4}, {0.7, 0.7, 0.7});
  EXPECT_NEAR(round.evaluate(1.1).curvature(), 1 / 0.7, 1e-14);
}

TEST(Curve, NaturalSplinesGoOnStraight) {
  const C curve = open_curve();
  const CurvePoint<double> end = curve.evaluate(curve.last()), beyond = curve.evaluate(curve.last() + 2);
  expect_near(beyond.p, end.p + 2.0 * end.d1, 1e-14);
  EXPECT_EQ(beyond.curvature(), 0);
}

TEST(Curve, ShapeDerivatives) {
  const double h = 1e-5;
  const auto plain = [](double a, double b) {
    return egg({-0.5, 0.5 + a, 1.7, 3.0, 4.4}, {1.0, 1.3 + b, 1.1, 0.9, 0.95});
  };
  const std::vector<D> angles = {-0.5, 0.5 + D::variable(0, 0), 1.7, 3.0, 4.4};
  const std::vector<D> radii = {1.0, 1.3 + D::variable(0, 1), 1.1, 0.9, 0.95};
  const Curve<D> dual = Curve<D>::polar(angles, radii);
  for (const double s : {0.2, 2.5, 5.6}) {
    const CurvePoint<D> found = dual.evaluate(D(s));
    const CurvePoint<double> a1 = plain(h, 0).evaluate(s), a0 = plain(-h, 0).evaluate(s);
    const CurvePoint<double> b1 = plain(0, h).evaluate(s), b0 = plain(0, -h).evaluate(s);
    expect_near({found.p.x.d[0], found.p.y.d[0]}, (a1.p - a0.p) / (2 * h), 1e-8);
    expect_near({found.p.x.d[1], found.p.y.d[1]}, (b1.p - b0.p) / (2 * h), 1e-8);
    EXPECT_NEAR(found.curvature().d[1], (b1.curvature() - b0.curvature()) / (2 * h), 1e-7);
    // The body coordinates of a contact move the parameter, the design the shape: both at once.
    const CurvePoint<Taylor<D>> moving = dual.evaluate(Taylor<D>(D(s), D(2.0), D(0.0)));
    EXPECT_NEAR(moving.p.x.d.d[1], 2 * found.d1.x.d[1], 1e-13);
  }
}

TEST(Curve, RefusesWhatIsNoCurve) {
  const double nan = std::nan("");
  EXPECT_EQ(refusal([] { return C::circle({0, 0}, 0); }), "curve: the circle's radius must be positive, is 0");
  EXPECT_EQ(refusal([&] { return C::circle({0, nan}, 1); }), "curve: the circle's centre is not finite");
  EXPECT_EQ(refusal([] {
              return C::line({0, 0}, {0, 0});
            }),
            "curve: the length of the line's axis must be positive, is 0");
  EXPECT_EQ(refusal([] {
              return through({{0, 0}}, SplineEnd::natural);
            }),
            "curve: needs at least 2 different points, has 1");
  EXPECT_EQ(refusal([] { return through({}, SplineEnd::periodic); }),
            "curve: needs at least 3 different points, has 0");
  EXPECT_EQ(refusal([] {
              return through({{0, 0}, {1, 0}, {0, 0}}, SplineEnd::periodic);
            }),
            "curve: needs at least 3 different points, has 2");
  EXPECT_EQ(refusal([] {
              return through({{0, 0}, {1, 1}, {1, 1}}, SplineEnd::natural);
            }),
            "curve: points[2] coincides with the point before it");
  EXPECT_EQ(refusal([&] { return through({{0, 0}, {nan, 1}}, SplineEnd::natural); }), "curve: points[1] is not finite");
  EXPECT_EQ(refusal([] {
              return through({{0, 0}, {1, 1}}, SplineEnd::clamped);
            }),
            "curve: a spline through points ends natural or periodic, not clamped");
  EXPECT_EQ(refusal([] { return egg({0, 1}, {1, 1}); }), "curve: needs at least 3 angles, has 2");
  EXPECT_EQ(refusal([] { return egg({0, 1, 2}, {1, 1}); }), "curve: 3 angles, but 2 radii");
  EXPECT_EQ(refusal([] { return egg({0, 1, 2}, {1, -1, 1}); }), "curve: radius[1] must be positive, is -1");
  EXPECT_EQ(refusal([] { return egg({0, 1, 6.5}, {1, 1, 1}); }), "curve: the angles span 6.5 rad, more than one turn");
  EXPECT_EQ(refusal([] {
              return egg({0, 2, 1}, {1, 1, 1});
            }),
            "spline: knots must increase, but knot[2] = 1 follows 2");
  EXPECT_EQ(refusal([] {
              return egg({0, 2, 2 * pi}, {1, 1, 2});
            }),
            "curve: the full turn starts at radius 1 and ends at 2");
}

}  // namespace
}  // namespace catena
