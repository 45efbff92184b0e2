// Viscous damping of joints, key `c`, against exponentials.
#include <gtest/gtest.h>

#include <cmath>

#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A rod of 2 kg that turns about its end, and a block of 3 kg in a guide of the ground that slopes; no gravity.
std::string scene(const std::string& analyses) {
  return R"({"catena": 1, "gravity": [0, 0], "parameters": {"turning": 0.4, "sliding": 1.5},
    "bodies": {
      "rod": {"mass": 2, "inertia": 0.5, "position": [1, 0], "velocity": [0, 3], "angular_velocity": 3},
      "block": {"mass": 3, "inertia": 1, "position": [5, 0], "velocity": [1.2, 1.6]}},
    "constraints": [
      {"type": "revolute", "name": "pin", "i": "ground", "j": ["rod", [-1, 0]], "c": "=turning"},
      {"type": "translational", "name": "guide", "i": ["ground", [5, 0]], "j": "block", "axis_i": [3, 4],
       "c": "=sliding"}],
    "outputs": ["pin.omega", "guide.slide_rate", "energy.balance", "energy.dissipated", "pin.torque"],
    "analyses": [)" +
         analyses + "]}";
}

TEST(JointDamping, SlowsTurningAndSlidingExponentially) {
  const double inertia = 0.5 + 2, t = 1.7;
  const TextRun run = run_text(scene(R"({"type": "dynamics", "at": [1.7], "tolerance": 1e-11})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double omega = 3 * std::exp(-0.4 * t / inertia), rate = 2 * std::exp(-1.5 * t / 3);
  EXPECT_NEAR(run.last("pin.omega"), omega, 1e-9);
  EXPECT_NEAR(run.last("guide.slide_rate"), rate, 1e-9);
  EXPECT_NEAR(run.last("energy.dissipated"), inertia * (9 - omega * omega) / 2 + 3 * (4 - rate * rate) / 2, 1e-8);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
}

TEST(JointDamping, HasDerivatives) {
  const TextRun run = run_text(scene(R"({"type": "sensitivity", "parameters": ["turning", "sliding"],
    "of": {"type": "dynamics", "at": [1.7], "tolerance": 1e-11,
           "measures": {"omega": {"final": "pin.omega"}, "rate": {"final": "guide.slide_rate"}}}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double t = 1.7;
  EXPECT_NEAR(run.last("d(pin.omega)/d(turning)"), -t / 2.5 * 3 * std::exp(-0.4 * t / 2.5), 1e-8);
  EXPECT_NEAR(run.last("d(guide.slide_rate)/d(sliding)"), -t / 3 * 2 * std::exp(-1.5 * t / 3), 1e-8);
  EXPECT_NEAR(run.last("d(pin.omega)/d(sliding)"), 0, 1e-10);
}

// A guide that itself turns and moves: damping acts along it, and the balance of energy closes.
TEST(JointDamping, ActsBetweenMovingBodies) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {
      "arm": {"mass": 2, "inertia": 0.5, "position": [0.5, 0]},
      "slider": {"mass": 1, "inertia": 0.1, "position": [0.8, 0]}},
    "constraints": [
      {"type": "revolute", "name": "pin", "i": "ground", "j": ["arm", [-0.5, 0]], "c": 0.3},
      {"type": "translational", "name": "guide", "i": "arm", "j": "slider", "axis_i": [1, 0], "c": 2}],
    "outputs": ["guide.slide", "energy.balance", "energy.dissipated"],
    "analyses": [{"type": "dynamics", "until": 1, "every": 0.1, "tolerance": 1e-11}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (const double balance : run.column("energy.balance")) EXPECT_NEAR(balance, 0, 1e-8);
  EXPECT_GT(run.last("energy.dissipated"), 0.1);
}

// No damping yet has a derivative too: an optimisation may start there.
TEST(JointDamping, HasDerivativesWhereItIsZero) {
  std::string text = scene(R"({"type": "sensitivity", "parameters": ["turning"],
    "of": {"type": "dynamics", "at": [1.7], "tolerance": 1e-11, "measures": {"omega": {"final": "pin.omega"}}}})");
  text.replace(text.find("\"turning\": 0.4"), 14, "\"turning\": 0");
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("d(pin.omega)/d(turning)"), -1.7 / 2.5 * 3, 1e-8);
}

// The damper would go on without its joint.
TEST(JointDamping, GoesNotWithReleases) {
  const TextRun run = run_text(scene(R"({"type": "dynamics", "until": 1,
    "events": [{"when": "t", "value": 0.5, "action": "release", "element": "pin"}]})"));
  EXPECT_EQ(run.outcome.exit_code, 3);
  EXPECT_NE(run.outcome.error_text.find("\"pin\" has damping"), std::string::npos) << run.outcome.error_text;
}

TEST(JointDamping, IsNotNegativeInPrograms) {
  Model model;
  const int rod = model.add_body("rod", {.mass = 1, .inertia = 1});
  Revolute<> pin;
  pin.c = -1;
  EXPECT_THROW(model.add("pin", pin, ground, rod), ModelError);
}

TEST(JointDamping, IsNotNegative) {
  std::string text = scene(R"({"type": "check"})");
  text.replace(text.find("\"turning\": 0.4"), 14, "\"turning\": -1");
  const TextRun run = run_text(text);
  EXPECT_EQ(run.outcome.exit_code, 3);
  EXPECT_NE(run.outcome.error_text.find("\"c\" of revolute \"pin\""), std::string::npos) << run.outcome.error_text;
}

}  // namespace
}  // namespace catena::testing
