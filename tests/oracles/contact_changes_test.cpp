// What contacts do where something else changes: a place opens because another is hit, constraints are engaged, drivers
// jump or move what is hit, angles bound a small mechanism. Against impulse balances and parabolas.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81;

TextRun run_of(const std::string& parts, const std::string& gravity = "[0, -9.81]") {
  TextRun run = run_text(R"({"catena": 1, "gravity": )" + gravity + ", " + parts + "}");
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text
                                      << (run.outcome.analyses.empty() ? "" : run.analysis().report.message);
  return run;
}

// A plank lies on two supports and a ball falls onto its end beyond the right one: the left end leaves its support.
//   plank  V = -J + P (both over m), about the centre  I w = J b - P a  (clockwise), right support at rest: V = w a
//   ball   -v + J / m_ball = -(w b - V)        no restitution
TEST(ContactChanges, APlankLeavesOneSupportWhereABallHitsIt) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double m = random(1, 5), length = random(1, 3), a = length * random(0.2, 0.3),
                 b = length * random(0.35, 0.48);
    const double ball = random(0.1, 1), height = random(0.1, 0.5);
    const double inertia = m * length * length / 12, v = std::sqrt(2 * g * height);
    // About the right support, with d = b - a: the ball's momentum about it sets plank and ball turning.
    const double d = b - a, about = inertia + m * a * a;
    const double w = ball * v * d / (about + ball * d * d), hit = v / g;
    // Afterwards the plank turns about the right support and the ball goes with its end, if it stays on it: the balance
    // of moments gives the angle's start, w, and its second derivative at the level position.
    const double acceleration = (ball * g * d - m * g * a) / (about + ball * d * d), later = 1e-3;
    const TextRun run = run_of(R"("bodies": {"plank": {"mass": )" + text_of(m) + R"(, "inertia": )" + text_of(inertia) +
                               R"(, "position": [0, 0], "points": {"left": )" + pair_of(-a, 0) + R"(, "right": )" +
                               pair_of(a, 0) + R"(}},
           "ball": {"particle": true, "mass": )" +
                               text_of(ball) + R"(, "position": [)" + text_of(b) + "," + text_of(height) + R"(]}},
        "forces": [
          {"type": "contact", "name": "left", "i": "ground", "j": "plank.left", "curve": {"line": {"point": [0,0], "axis": [1,0]}}},
          {"type": "contact", "name": "right", "i": "ground", "j": "plank.right", "mu": 2, "curve": {"line": {"point": [0,0], "axis": [1,0]}}},
          {"type": "contact", "name": "hit", "i": "plank", "j": "ball", "mu": 2, "curve": {"line": {"point": [0,0], "axis": [1,0]}}}],
        "outputs": ["plank.angle", "plank.omega", "left.gap"],
        "analyses": [{"type": "dynamics", "at": [)" +
                               text_of(hit - 1e-6) + "," + text_of(hit + later) + R"(], "tolerance": 1e-11}])");
    EXPECT_NEAR(run.first("plank.omega"), 0, 1e-9);
    // The next terms of the series are of the size of w^2 later.
    EXPECT_NEAR(run.last("plank.omega"), -(w + acceleration * later), 1e-5 * w);
    EXPECT_NEAR(run.last("plank.angle"), -(w * later + acceleration * later * later / 2), 1e-5 * w * later);
  }
}

// A block slides on a smooth floor until its lower front corner is caught: it trips about that corner.
TEST(ContactChanges, ABlockTripsOverAPinThatIsEngaged) {
  const double m = 2, width = 0.4, height = 0.3, v = 0.5, when = 0.2;
  const double inertia = m * (width * width + height * height) / 12;
  const double about = inertia + m * (width * width + height * height) / 4, w = m * v * (height / 2) / about;
  const double slowing = m * g * (width / 2) / about, later = 1e-3;
  const TextRun run = run_of(
      R"("bodies": {"block": {"mass": 2, "inertia": )" + text_of(inertia) +
      R"(, "position": [0, 0.15], "velocity": [0.5, 0], "points": {"rear": [-0.2, -0.15], "front": [0.2, -0.15]}}},
      "constraints": [{"type": "revolute", "name": "pin", "i": ["ground", [0.3, 0]], "j": "block.front"}],
      "forces": [
        {"type": "contact", "name": "rear", "i": "ground", "j": "block.rear", "curve": {"line": {"point": [0,0], "axis": [1,0]}}},
        {"type": "contact", "name": "front", "i": "ground", "j": "block.front", "curve": {"line": {"point": [0,0], "axis": [1,0]}}}],
      "outputs": ["block.omega", "rear.gap", "energy.dissipated"],
      "analyses": [{"type": "dynamics", "at": [)" +
      text_of(when + later) + R"(], "tolerance": 1e-11,
        "events": [{"name": "caught", "when": "block.x", "value": 0.1, "action": "engage", "element": "pin"}]}])");
  EXPECT_NEAR(run.last("block.omega"), -(w - slowing * later), 1e-5 * w);
  EXPECT_NEAR(run.last("energy.dissipated"), m * v * v / 2 - about * w * w / 2, 1e-8);
  EXPECT_GT(run.last("rear.gap"), 0);
}

// A platform rises with v and stops at once: what lies on it flies on, lands and bounces.
TEST(ContactChanges, WhatLiesOnAPlatformFliesOnWhenItStops) {
  const double v = 1, e = 0.5, lands = 1 + 2 * v / g, later = lands + 0.05;
  const TextRun run = run_of(R"(
      "bodies": {"platform": {"mass": 1, "inertia": 1}, "ball": {"particle": true, "mass": 2, "velocity": [0, 1]}},
      "constraints": [
        {"type": "absolute_x", "i": "platform", "value": 0}, {"type": "absolute_angle", "i": "platform", "value": 0},
        {"type": "absolute_y", "name": "lift", "i": "platform",
         "value": {"spline": {"t": [0, 1], "value": [0, 1], "end": "natural", "beyond": "hold"}}}],
      "forces": [{"type": "contact", "name": "floor", "i": "platform", "j": "ball", "restitution": 0.5,
                  "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
      "outputs": ["ball.y", "ball.vy", "platform.y"],
      "analyses": [{"type": "dynamics", "at": [0.5, 1.1, )" +
                             text_of(later) + R"(], "tolerance": 1e-11}])");
  const std::vector<double> y = run.column("ball.y");
  ASSERT_EQ(y.size(), 3U);
  EXPECT_NEAR(y[0], 0.5, 1e-10);
  EXPECT_NEAR(y[1], 1 + v * 0.1 - g * 0.01 / 2, 1e-9);
  EXPECT_NEAR(y[2], 1 + e * v * 0.05 - g * 0.0025 / 2, 1e-9);
}

// A platform that rests is set in motion at once: what lies on it is thrown up with its speed and the rebound.
TEST(ContactChanges, APlatformThatJumpsIntoMotionThrowsWhatLiesOnIt) {
  const double v = 1, e = 0.5, start = 0.5, later = 0.05;
  const TextRun run = run_of(R"(
      "bodies": {"platform": {"mass": 1, "inertia": 1}, "ball": {"particle": true, "mass": 2}},
      "constraints": [
        {"type": "absolute_x", "i": "platform", "value": 0}, {"type": "absolute_angle", "i": "platform", "value": 0},
        {"type": "absolute_y", "name": "lift", "i": "platform",
         "value": {"spline": {"t": [0.5, 1.5], "value": [0, 1], "end": "natural", "beyond": "hold"}}}],
      "forces": [{"type": "contact", "name": "floor", "i": "platform", "j": "ball", "restitution": 0.5,
                  "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
      "outputs": ["ball.y"],
      "analyses": [{"type": "dynamics", "at": [0.4, )" +
                             text_of(start + later) + R"(], "tolerance": 1e-11}])");
  EXPECT_NEAR(run.first("ball.y"), 0, 1e-10);
  EXPECT_NEAR(run.last("ball.y"), (1 + e) * v * later - g * later * later / 2, 1e-9);
}

// An elastic ball falls onto a rising platform: it comes back faster than it fell, by twice the platform's speed.
TEST(ContactChanges, ADrivenPlatformDoesWorkOnWhatHitsIt) {
  const double up = 1, fall = 2;
  const TextRun run = run_of(R"(
      "bodies": {"platform": {"mass": 1, "inertia": 1},
                 "ball": {"particle": true, "mass": 2, "position": [0, 0.3], "velocity": [0, -2]}},
      "constraints": [
        {"type": "absolute_x", "i": "platform", "value": 0}, {"type": "absolute_angle", "i": "platform", "value": 0},
        {"type": "absolute_y", "name": "lift", "i": "platform", "value": {"polynomial": [0, 1]}}],
      "forces": [{"type": "contact", "name": "floor", "i": "platform", "j": "ball", "restitution": 1,
                  "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
      "outputs": ["ball.vy", "ball.y"],
      "analyses": [{"type": "dynamics", "at": [0.3], "tolerance": 1e-11}])",
                             "[0, 0]");
  EXPECT_NEAR(run.last("ball.vy"), up + (fall + up), 1e-10);
  EXPECT_NEAR(run.last("ball.y"), 0.1 + 0.2 * 4, 1e-9);
}

// An angle is compared with radians, however small the mechanism: a stop that is closed to 1e-8 rad is closed.
TEST(ContactChanges, AnglesOfSmallMechanismsAreMeasuredInRadians) {
  for (const double size : {1.0, 1e-3, 1e-6}) {
    SCOPED_TRACE(size);
    const std::string half = text_of(size / 2), start = text_of(-1e-8);
    const TextRun run = run_of(R"("bodies": {"rod": {"mass": 1, "inertia": )" + text_of(size * size / 12) +
                               R"(, "angle": )" + start + R"(, "position": [)" + half + R"(, 0]}},
        "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": ["rod", [-)" +
                               half + R"(, 0]]}],
        "forces": [{"type": "stop", "name": "rest", "column": "rod.angle", "min": 0}],
        "outputs": ["rod.angle", "rest.force"],
        "analyses": [{"type": "dynamics", "at": [0, 0.1], "tolerance": 1e-9}])");
    EXPECT_NEAR(run.last("rod.angle"), 0, 2e-8);
    EXPECT_NEAR(run.last("rest.force") / (g * size / 2), 1, 1e-6);
  }
}

}  // namespace
}  // namespace catena::testing
