// Points on curves, cams on flat faces and on each other where the answer is known in closed form, and where there is
// none.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "catena/elements/all.hpp"

namespace catena {
namespace {

constexpr double pi = std::numbers::pi;
const Frame<double> origin;

/// The row where the contact has moved on from where it was.
template <class E>
double row_of(const E& element, const Frame<double>& i, const Frame<double>& j, CurvePlace& contact) {
  double row;
  element.follow_contact(i, j, contact);
  element.phi(Arguments<double>{i, j, 0, {}, &contact}, &row);
  return row;
}
/// From the given configuration.
template <class E>
double row_of(const E& element, const Frame<double>& i, const Frame<double>& j) {
  CurvePlace contact = element.place();
  return row_of(element, i, j, contact);
}
template <class E>
std::string trouble_of(const E& element, const Frame<double>& i, const Frame<double>& j) {
  CurvePlace contact = element.place();
  element.follow_contact(i, j, contact);
  const char* text = element.trouble(Arguments<double>{i, j, 0, {}, &contact});
  return text ? text : "";
}

/// A figure of eight, crossing itself at the origin.
Curve<double> figure_of_eight() {
  std::vector<Vec2<double>> points;
  for (int k = 0; k < 64; ++k) {
    const double t = 2 * pi * k / 64;
    points.push_back({std::sin(t), std::sin(2 * t) / 2});
  }
  return Curve<double>::spline(points, SplineEnd::periodic);
}

TEST(PointOnCurve, MeasuresTheDistanceToTheLeft) {
  PointOnCurve<double> circle{.curve = Curve<double>::circle({0.5, 0}, 0.2)};
  circle.complete(origin, make_frame(1.0, 0.0, 0.0));
  // Counter-clockwise: the inside is on the left.
  EXPECT_NEAR(row_of(circle, origin, make_frame(1.0, 0.0, 0.0)), -0.3, 1e-15);
  EXPECT_NEAR(row_of(circle, origin, make_frame(0.5, 0.1, 0.0)), 0.1, 1e-15);
  PointOnCurve<double> line{.curve = Curve<double>::line({0, 1}, {3, 0})};
  line.complete(origin, origin);
  EXPECT_NEAR(row_of(line, origin, make_frame(700.0, 3.5, 0.0)), 2.5, 1e-15);
}

// Driven along a curve that crosses itself, the point stays on the branch it came on.
TEST(PointOnCurve, FollowsItsBranchThroughACrossing) {
  const Curve<double> curve = figure_of_eight();
  PointOnCurve<double> pin{.curve = curve};
  const auto at = [&](double s) {
    const CurvePoint<double> c = curve.evaluate(s);
    return make_frame(c.p.x, c.p.y, 0.0);
  };
  const double start = curve.last() * 0.4, end = curve.last() * 0.6;
  pin.complete(origin, at(start));
  CurvePlace contact = pin.place();
  for (double s = start; s < end; s += curve.last() / 500) {
    EXPECT_NEAR(row_of(pin, origin, at(s), contact), 0, 1e-15);
    EXPECT_NEAR(contact.s_i, s, 1e-9);
  }
}

// A jump to the other side of the cam is no place that Newton's method reaches from the old foot: it searches anew.
TEST(PointOnCurve, SearchesAnewAfterAJump) {
  std::vector<Vec2<double>> ellipse;
  for (int k = 0; k < 40; ++k) ellipse.push_back({2 * std::cos(2 * pi * k / 40), std::sin(2 * pi * k / 40)});
  PointOnCurve<double> point{.curve = Curve<double>::spline(ellipse, SplineEnd::periodic)};
  point.complete(origin, make_frame(3.0, 0.0, 0.0));
  CurvePlace foot = point.place();
  EXPECT_NEAR(row_of(point, origin, make_frame(3.0, 0.0, 0.0), foot), -1, 1e-12);
  EXPECT_NEAR(row_of(point, origin, make_frame(-5.0, 0.0, 0.0), foot), -3, 1e-12);
  EXPECT_NEAR(row_of(point, origin, make_frame(0.0, 1.5, 0.0), foot), -0.5, 1e-12);
}

TEST(PointOnCurve, GoesOnStraightBeyondOpenEnds) {
  const std::array<Vec2<double>, 3> points = {{{0, 0}, {1, 0.2}, {2, 0}}};
  const Curve<double> arc = Curve<double>::spline(points, SplineEnd::natural);
  PointOnCurve<double> point{.curve = arc};
  const CurvePoint<double> end = arc.evaluate(arc.last());
  const Vec2<double> beyond = end.p + 0.7 * end.tangent() + 0.3 * end.normal();
  point.complete(origin, make_frame(beyond.x, beyond.y, 0.0));
  EXPECT_NEAR(row_of(point, origin, make_frame(beyond.x, beyond.y, 0.0)), 0.3, 1e-14);
}

TEST(PointOnCurve, SaysThatACentreOfCurvatureIsSingular) {
  PointOnCurve<double> point{.curve = Curve<double>::circle({0.5, 0}, 0.2)};
  const Frame<double> centre = make_frame(0.5, 0.0, 0.0);
  point.complete(origin, centre);
  EXPECT_NEAR(row_of(point, origin, centre), 0.2, 1e-15);
  EXPECT_EQ(trouble_of(point, origin, centre), "the point is at a centre of curvature of the curve");
  EXPECT_EQ(trouble_of(point, origin, make_frame(0.5, 0.1, 0.0)), "");
}

// An eccentric disc under a flat face lifts it by r + e sin(angle).
TEST(CamFlat, EccentricDiscLiftsAsASine) {
  const double e = 0.02, r = 0.05;
  CamFlat<double> cam{.axis_j = {-2, 0}, .curve = Curve<double>::circle({e, 0}, r)};
  const auto face = [&](double lift) { return make_frame(0.3, lift, 0.0); };
  cam.complete(origin, face(r));
  ASSERT_EQ(cam.check(), nullptr);
  for (double angle = -7; angle < 7; angle += 0.3) {
    const Frame<double> turned = make_frame(0.0, 0.0, angle);
    EXPECT_NEAR(row_of(cam, turned, face(r + e * std::sin(angle))), 0, 1e-16);
    EXPECT_NEAR(row_of(cam, turned, face(r + e * std::sin(angle) + 0.01)), 0.01, 1e-16);
  }
}

// The face below the cam as well as above, whichever way its axis points; the nearer side is meant.
TEST(CamFlat, TakesTheNearerSideOfTheCam) {
  for (const double direction : {1.0, -1.0}) {
    for (const double height : {0.06, -0.06}) {
      CamFlat<double> cam{.axis_j = {direction, 0}, .curve = Curve<double>::circle({0, 0}, 0.05)};
      cam.complete(origin, make_frame(0.0, height, 0.0));
      EXPECT_NEAR(std::abs(row_of(cam, origin, make_frame(0.0, height, 0.0))), 0.01, 1e-16);
    }
  }
}

TEST(CamFlat, RefusesALineAndSaysWhereAnArcEnds) {
  CamFlat<double> flat{.axis_j = {1, 0}, .curve = Curve<double>::line({}, {1, 0.5})};
  flat.complete(origin, origin);
  EXPECT_STREQ(flat.check(), "a straight line and a flat face have no point of contact");
  CamFlat<double> none{.axis_j = {1, 0}};
  none.complete(origin, origin);
  EXPECT_STREQ(none.check(), "has no curve");

  std::vector<Vec2<double>> quarter;
  for (int k = 0; k <= 8; ++k) quarter.push_back({std::cos(pi * k / 16), std::sin(pi * k / 16)});
  CamFlat<double> arc{.axis_j = {-1, 0}, .curve = Curve<double>::spline(quarter, SplineEnd::natural)};
  const Frame<double> face = make_frame(0.0, 1.0, 0.0);
  arc.complete(make_frame(0.0, 0.0, 0.5), face);
  EXPECT_EQ(trouble_of(arc, make_frame(0.0, 0.0, 0.5), face), "");
  EXPECT_EQ(trouble_of(arc, make_frame(0.0, 0.0, -0.5), face),
            "the cam has no curvature where it should touch the face");
  EXPECT_TRUE(std::isfinite(row_of(arc, make_frame(0.0, 0.0, -0.5), face)));
}

/// A circle as a spline, which the element does not know to be one.
Curve<double> round_spline(double radius) {
  std::vector<Vec2<double>> points;
  for (int k = 0; k < 90; ++k)
    points.push_back({radius * std::cos(2 * pi * k / 90), radius * std::sin(2 * pi * k / 90)});
  return Curve<double>::spline(points, SplineEnd::periodic);
}

// Circles touch where the distance of their centres is the sum of the radii, or inside each other the difference.
TEST(CamCam, CirclesKeepTheirCentresApart) {
  for (const bool inside : {false, true}) {
    for (const bool spline : {false, true}) {
      SCOPED_TRACE(::testing::Message() << (inside ? "inside" : "outside") << (spline ? ", splines" : ""));
      const double r_i = 0.5, r_j = 0.2, apart = inside ? r_i - r_j : r_i + r_j;
      CamCam<double> cams{.curve_i = spline ? round_spline(r_i) : Curve<double>::circle({}, r_i),
                          .curve_j = spline ? round_spline(r_j) : Curve<double>::circle({}, r_j)};
      const auto j = [](double distance, double direction, double angle) {
        return make_frame(distance * std::cos(direction), distance * std::sin(direction), angle);
      };
      cams.complete(origin, j(apart + 0.02, 0.3, 0));
      ASSERT_EQ(cams.check(), nullptr);
      const double accuracy = spline ? 2e-7 : 1e-15;
      for (double direction = 0.3; direction < 9; direction += 0.2) {
        const Frame<double> i = make_frame(0.0, 0.0, -2 * direction);
        EXPECT_NEAR(row_of(cams, i, j(apart, direction, 5 * direction)), 0, accuracy);
        // The gap is to the right of curve i outside of it, to the left inside.
        EXPECT_NEAR(row_of(cams, i, j(apart + 0.01, direction, 0)), -0.01, accuracy);
      }
    }
  }
}

TEST(CamCam, LineAndCircleInEitherOrder) {
  for (const bool line_is_i : {false, true}) {
    const Curve<double> line = Curve<double>::line({5, 0}, {1, 0}), circle = Curve<double>::circle({}, 0.5);
    CamCam<double> cams{.curve_i = line_is_i ? line : circle, .curve_j = line_is_i ? circle : line};
    const Frame<double> at = make_frame(300.0, 0.6, 0.0);
    const Frame<double>&i = line_is_i ? origin : at, &j = line_is_i ? at : origin;
    cams.complete(i, j);
    ASSERT_EQ(cams.check(), nullptr);
    EXPECT_NEAR(std::abs(row_of(cams, i, j)), 0.1, 1e-13);
  }
}

TEST(CamCam, RefusesWhatHasNoSinglePointOfContact) {
  CamCam<double> lines{.curve_i = Curve<double>::line({}, {1, 0}), .curve_j = Curve<double>::line({}, {1, 1})};
  lines.complete(origin, origin);
  EXPECT_STREQ(lines.check(), "two straight lines have no point of contact");
  CamCam<double> alone{.curve_i = Curve<double>::circle({}, 1)};
  alone.complete(origin, origin);
  EXPECT_STREQ(alone.check(), "lacks a curve");
  CamCam<double> concentric{.curve_i = Curve<double>::circle({}, 1), .curve_j = Curve<double>::circle({}, 0.5)};
  concentric.complete(origin, origin);
  EXPECT_STREQ(concentric.check(), "the cams have no common normal in the given configuration");

  CamCam<double> ring{.curve_i = Curve<double>::circle({}, 1), .curve_j = Curve<double>::circle({}, 0.5)};
  ring.complete(origin, make_frame(0.5, 0.0, 0.0));
  ASSERT_EQ(ring.check(), nullptr);
  EXPECT_EQ(trouble_of(ring, origin, make_frame(0.4, 0.0, 0.0)), "");
  EXPECT_EQ(trouble_of(ring, origin, origin), "the cams have no single point of contact: their curvatures are equal");
  EXPECT_TRUE(std::isfinite(row_of(ring, origin, origin)));
}

}  // namespace
}  // namespace catena
