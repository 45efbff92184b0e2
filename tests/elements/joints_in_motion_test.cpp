// Joints and contacts in driven mechanisms whose motion is known in closed form: positions, velocities, accelerations.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/cam_cam.hpp"
#include "catena/elements/constraints/cam_flat.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/point_on_curve.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

constexpr double pi = std::numbers::pi;
using Motion = std::function<Taylor<double>(const Taylor<double>&)>;

int add_body(Model& model, const char* name, const Vec2<double>& position, double angle = 0) {
  BodyValues values;
  values.position = position;
  values.angle = angle;
  return model.add_body(name, values);
}

TimeFunction<double> ramp(double start, double rate) {
  const double coefficients[] = {start, rate};
  return TimeFunction<double>::polynomial(coefficients);
}

/// Runs to `until` and compares coordinate k (0 x, 1 y, 2 angle) of a body with `expected` of time, with its rates.
void expect_motion(const Model& model, int body, int k, const Motion& expected, double until, double tolerance) {
  Kinematics kinematics(std::make_shared<const Model>(model));
  const auto plan_body = static_cast<std::size_t>(kinematics.plan().plan_body[static_cast<std::size_t>(body)]);
  const std::size_t c = 3 * plan_body + static_cast<std::size_t>(k);
  const Vec2<double> origin = kinematics.evaluator().origin(static_cast<int>(plan_body));
  int rows = 0;
  RowFunction check([&](const Snapshot& s) {
    const Taylor<double> exact = expected(Taylor<double>(s.t, 1, 0));
    const double here = s.q[c] + (k == 0 ? origin.x : k == 1 ? origin.y : 0);
    EXPECT_NEAR(here, exact.f, tolerance) << "at " << s.t;
    EXPECT_NEAR(s.qd[c], exact.d, 10 * tolerance * (1 + std::abs(exact.d))) << "at " << s.t;
    EXPECT_NEAR(s.qdd[c], exact.dd, 100 * tolerance * (1 + std::abs(exact.dd))) << "at " << s.t;
    ++rows;
    return true;
  });
  const AnalysisReport report =
      kinematics.run(TimeGrid::range(0, until, until / 40), {.velocity = true, .acceleration = true}, check);
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(rows, 41);
}

constexpr double eccentricity = 0.02, cam_radius = 0.05, speed = 3;

/// A disc that turns about a point `eccentricity` off its centre, under a follower that slides along y.
struct CamDrive {
  Model model;
  int cam, follower;

  explicit CamDrive(double lift) {
    cam = add_body(model, "cam", {});
    follower = add_body(model, "follower", {0, lift});
    model.add("pin", Revolute<double>{}, ground, cam);
    model.add("guide", Translational<double>{.axis_i = {0, 1}}, ground, follower);
    model.add_driver("drive", AbsoluteAngle<double>{}, cam, ground, ramp(0, speed));
  }
  static Curve<double> disc() { return Curve<double>::circle({eccentricity, 0}, cam_radius); }
};

TEST(JointsInMotion, FlatFaceOnEccentricDisc) {
  CamDrive drive(cam_radius);
  drive.model.add("contact", CamFlat<double>{.axis_j = {1, 0}, .curve = CamDrive::disc()}, drive.cam, drive.follower);
  expect_motion(
      drive.model, drive.follower, 1,
      [](const Taylor<double>& t) {
        return Taylor<double>(cam_radius) + Taylor<double>(eccentricity) * sin(Taylor<double>(speed) * t);
      },
      5, 1e-14);
}

/// Height of the centre of a roller on the disc: the centres keep the sum of the radii.
Taylor<double> roller_height(double roller, const Taylor<double>& t) {
  const Taylor<double> angle = Taylor<double>(speed) * t, across = Taylor<double>(eccentricity) * cos(angle);
  const double reach = cam_radius + roller;
  return Taylor<double>(eccentricity) * sin(angle) + sqrt(Taylor<double>(reach * reach) - across * across);
}

TEST(JointsInMotion, KnifeEdgeOnEccentricDisc) {
  CamDrive drive(cam_radius);
  drive.model.add("contact", PointOnCurve<double>{.curve = CamDrive::disc()}, drive.cam, drive.follower);
  expect_motion(
      drive.model, drive.follower, 1, [](const Taylor<double>& t) { return roller_height(0, t); }, 5, 1e-14);
}

TEST(JointsInMotion, RollerOnEccentricDisc) {
  const double roller = 0.015;
  CamDrive drive(cam_radius + roller);
  drive.model.add("contact", CamCam<double>{.curve_i = CamDrive::disc(), .curve_j = Curve<double>::circle({}, roller)},
                  drive.cam, drive.follower);
  expect_motion(
      drive.model, drive.follower, 1, [&](const Taylor<double>& t) { return roller_height(roller, t); }, 5, 1e-14);
}

// The ring is the ground: the carrier turns at zs / (zs + zr) of the sun's speed, here for a hundred turns of the sun.
TEST(JointsInMotion, PlanetarySetOverManyTurns) {
  const double sun = 0.020, planet = 0.025, ring = 0.070;
  Model model;
  const int s = add_body(model, "sun", {}), c = add_body(model, "carrier", {}),
            p = add_body(model, "planet", {sun + planet, 0});
  model.add("sun pin", Revolute<double>{}, ground, s);
  model.add("carrier pin", Revolute<double>{}, ground, c);
  model.add("planet pin", Revolute<double>{.s_i = {sun + planet, 0}}, c, p);
  model.add("outer", Gear<double>{.radius_i = sun, .radius_j = planet}, s, p);
  model.add("inner", Gear<double>{.radius_i = ring, .radius_j = planet, .internal = true}, ground, p);
  model.add_driver("drive", AbsoluteAngle<double>{}, s, ground, ramp(0, 100));
  // Angles of up to 628 rad carry a rounding of 1e-13.
  expect_motion(
      model, c, 2, [](const Taylor<double>& t) { return Taylor<double>(200.0 / 9) * t; }, 2 * pi, 1e-12);
  expect_motion(
      model, p, 2, [](const Taylor<double>& t) { return Taylor<double>(-40.0) * t; }, 2 * pi, 1e-12);
}

// beta = atan2(R sin a, C - R cos a) while the pin is in the slot: |a| < 45 degrees.
TEST(JointsInMotion, GenevaWheel) {
  const double centre = 0.1, radius = centre * std::sin(pi / 4), start = -44 * pi / 180, rate = 10;
  Model model;
  const int crank = add_body(model, "crank", {}, start), wheel = add_body(model, "wheel", {centre, 0}, 0.7);
  model.add("crank pin", Revolute<double>{}, ground, crank);
  model.add("wheel pin", Revolute<double>{.s_i = {centre, 0}}, ground, wheel);
  model.add("slot", Slot<double>{.s_j = {radius, 0}, .axis_i = {1, 0}}, wheel, crank);
  model.add_driver("drive", AbsoluteAngle<double>{}, crank, ground, ramp(start, rate));
  expect_motion(
      model, wheel, 2,
      [&](const Taylor<double>& t) {
        const Taylor<double> a = Taylor<double>(start) + Taylor<double>(rate) * t;
        // The wheel turns against the crank.
        return -atan2(Taylor<double>(radius) * sin(a), Taylor<double>(centre) - Taylor<double>(radius) * cos(a));
      },
      88 * pi / 180 / rate, 1e-13);
}

TEST(JointsInMotion, PinionRollsAlongItsRack) {
  const double radius = 0.04;
  Model model;
  const int pinion = add_body(model, "pinion", {0, radius});
  model.add("mesh", RackPinion<double>{.axis_i = {1, 0}, .radius = radius}, ground, pinion);
  model.add_driver("drive", AbsoluteAngle<double>{}, pinion, ground, ramp(0, -2.5));
  expect_motion(
      model, pinion, 0, [&](const Taylor<double>& t) { return Taylor<double>(2.5 * radius) * t; }, 8, 1e-14);
}

TEST(JointsInMotion, BeltsTurnTheirPulleys) {
  for (const bool crossed : {false, true}) {
    Model model;
    const int a = add_body(model, "a", {}), b = add_body(model, "b", {0.3, 0.4});
    model.add("pin a", Revolute<double>{}, ground, a);
    model.add("pin b", Revolute<double>{.s_i = {0.3, 0.4}}, ground, b);
    model.add("belt", Belt<double>{.radius_i = 0.1, .radius_j = 0.04, .crossed = crossed}, a, b);
    model.add_driver("drive", AbsoluteAngle<double>{}, a, ground, ramp(0, 4));
    expect_motion(
        model, b, 2, [&](const Taylor<double>& t) { return Taylor<double>(crossed ? -10.0 : 10.0) * t; }, 9, 1e-13);
  }
}

}  // namespace
}  // namespace catena
