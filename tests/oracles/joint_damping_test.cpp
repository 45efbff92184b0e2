// Viscous damping of joints, key `c`, against exponentials; what dampers take and drivers do where drivers move all, so
// that nothing in the motion tells how short a step has to be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
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

// A block that is driven by a sin(w t) past the end of a damper, at a distance from which its direction turns within a
// thousandth of a swing: c (v x / r)^2, summed up by the middle rule.
TEST(DrivenWork, OfADamperThatIsPassed) {
  expect_no_fault(1, size_of_test(36u, 6u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double a = random(0.1, 0.5), w = random(2, 6), beside = std::pow(10, random(-3, -0.5)), c = random(1, 10);
    const double k = random(0, 30), until = random(2, 4);
    const char* const methods[] = {"rk8", "rk5", "adams", "radau", "auto"};
    const double tolerance = std::pow(10, -6.0 - seed % 4);
    double taken = 0;
    constexpr int parts = 400'000;
    for (int n = 0; n < parts; ++n) {
      const double t = until * (n + 0.5) / parts, x = a * std::sin(w * t), v = a * w * std::cos(w * t);
      taken += c * v * v * x * x / (x * x + beside * beside) * until / parts;
    }
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
        "constraints": [{"type": "translational", "i": "ground", "j": "b", "axis_i": [1, 0]}],
        "drivers": [{"type": "absolute_x", "name": "d", "i": "b", "value": {"harmonic": {"amplitude": )" +
        text_of(a) + R"(, "omega": )" + text_of(w) + R"(}}}],
        "forces": [{"type": "spring_damper", "i": ["ground", )" +
        pair_of(0, beside) + R"(], "j": "b", "length": 0, "k": )" + text_of(k) + R"(, "c": )" + text_of(c) +
        R"(}], "outputs": ["d.work", "energy"], "analyses": [{"type": "dynamics", "digits": false, "until": )" +
        text_of(until) + R"(, "every": )" + text_of(until / 7) + R"(, "method": ")" + methods[seed % 5] +
        R"(", "tolerance": )" + text_of(tolerance) + "}]}");
    if (!run.analysis().report.ok()) return run.analysis().report.message;
    const double x = a * std::sin(w * until), v = a * w * std::cos(w * until);
    const double done = taken + v * v - a * a * w * w + k * x * x / 2;
    const double allowed = 1e-8 + 1000 * tolerance * (taken + a * a * w * w);
    const double off = std::max(std::abs(run.last("energy.dissipated") - taken), std::abs(run.last("d.work") - done));
    return off <= allowed ? "" : text_of(off) + " off, allowed " + text_of(allowed);
  });
}

// The same against a stop, whose force bends at its end and has bent away again where it lets go.
TEST(DrivenWork, OfAStopThatIsHit) {
  expect_no_fault(1, size_of_test(72u, 6u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double a = random(0.3, 0.5), w = random(2, 6), end = random(0.1, 0.25), until = random(2, 4);
    const double k = std::pow(10, random(2, 5)), c = seed % 2 == 0 ? 0 : random(0.1, 1) * std::sqrt(k);
    const char* const methods[] = {"rk8", "rk5", "adams", "radau", "auto", "alpha"};
    const bool second_order = seed % 6 == 5;
    const double tolerance = second_order ? std::pow(10, -5.0 - seed / 6 % 2) : std::pow(10, -5.0 - seed / 6 % 8);
    // It closes where x reaches the end, and lets go where its force comes to nothing.
    double taken = 0;
    constexpr int parts = 100'000;
    const double closes = std::asin(end / a), opens = std::numbers::pi - closes;
    for (double turn = 0; (closes + turn) / w < until; turn += 2 * std::numbers::pi) {
      const double from = (closes + turn) / w, length = std::min((opens + turn) / w, until) - from;
      for (int n = 0; n < parts; ++n) {
        const double t = from + length * (n + 0.5) / parts, x = a * std::sin(w * t) - end, v = a * w * std::cos(w * t);
        taken += std::max(k * x + c * v, 0.0) * v * length / parts;
      }
    }
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
        "constraints": [{"type": "translational", "i": "ground", "j": "b", "axis_i": [1, 0]}],
        "drivers": [{"type": "absolute_x", "name": "d", "i": "b", "value": {"harmonic": {"amplitude": )" +
        text_of(a) + R"(, "omega": )" + text_of(w) + R"(}}}],
        "forces": [{"type": "stop", "column": "b.x", "max": )" +
        text_of(end) + R"(, "k": )" + text_of(k) + R"(, "c": )" + text_of(c) +
        R"(}], "outputs": ["d.work", "energy"], "analyses": [{"type": "dynamics", "digits": false, "until": )" +
        text_of(until) + R"(, "every": )" + text_of(until / 7) + R"(, "method": ")" + methods[seed % 6] +
        R"(", "tolerance": )" + text_of(tolerance) + "}]}");
    if (!run.analysis().report.ok()) return run.analysis().report.message;
    const double v = a * w * std::cos(w * until), exchanged = a * a * w * w + k * a * a;
    const double off = std::abs(run.last("d.work") - (taken + v * v - a * a * w * w));
    const double allowed = (1e-9 + 1000 * tolerance) * exchanged;
    return off <= allowed ? "" : text_of(off) + " off, allowed " + text_of(allowed);
  });
}

// The same past the length of a cable, of which no error of the motion tells: what the driver does is the change of the
// energy.
TEST(DrivenWork, OfACableThatBecomesTaut) {
  for (const double k : {1e2, 1e4, 1e6}) {
    for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
      const TextRun run = run_text(
          R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
          "constraints": [{"type": "translational", "i": "ground", "j": "b", "axis_i": [1, 0]}],
          "drivers": [{"type": "absolute_x", "name": "d", "i": "b", "value": {"harmonic": {"amplitude": 0.3, "omega": 4}}}],
          "forces": [{"type": "cable", "i": "ground", "j": "b", "length": 0.2, "k": )" +
          text_of(k) +
          R"(}], "outputs": ["d.work", "energy"], "analyses": [{"type": "dynamics", "until": 3.2, "every": 0.4, "tolerance": )" +
          text_of(tolerance) + "}]}");
      ASSERT_TRUE(run.analysis().report.ok()) << k << " " << tolerance << ": " << run.analysis().report.message;
      const double x = 0.3 * std::sin(12.8), v = 1.2 * std::cos(12.8), stretch = std::max(std::abs(x) - 0.2, 0.0);
      const double done = v * v - 1.44 + k * stretch * stretch / 2;
      EXPECT_NEAR(run.last("d.work"), done, 1e-9 * (1 + k * stretch * stretch));
    }
  }
}

}  // namespace
}  // namespace catena::testing
