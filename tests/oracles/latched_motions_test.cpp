// Constraints that events engage at a value and release later: the column stays at its value to rounding while they
// hold, and may leave it to the side from which it came. Against free falls.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81;

std::vector<std::string> names_of_events(const TextRun& run, std::size_t k = 0) {
  std::vector<std::string> names;
  for (const EventEntry& event : events_of(run, k)) names.push_back(event.name);
  return names;
}

/// A mass thrown up at 4 m/s, which a latch at a height catches; analyses as given.
TextRun run_latch(const std::string& analyses, double height = 0.5, double speed = 4) {
  return run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81], "parameters": {{"v": {}, "h": {}}},
    "bodies": {{"b": {{"mass": 1, "particle": true, "position": [0, 0], "velocity": [0, "v"]}}}},
    "constraints": [{{"type": "absolute_x", "i": "b", "value": 0}},
                    {{"type": "absolute_y", "name": "latch", "i": "b", "value": "h"}}],
    "outputs": ["b.y", "b.vy"], "analyses": [{}]}})",
                              speed, height, analyses));
}

const std::string on = R"({"name": "on", "when": "b.y", "value": "h", "action": "engage", "element": "latch"})";
const std::string off = R"({"name": "off", "when": "t", "value": 1, "action": "release", "element": "latch"})";

TEST(LatchedMotions, AnOpenedLatchLetsGo) {
  expect_no_fault(1, size_of_test(40u, 8u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double speed = random(3, 6);
    const double height = speed * speed / (2 * g) * random(0.3, 0.95);
    const char* const methods[] = {"auto", "rk8", "rk5", "adams", "radau", "baumgarte", "partitioning"};
    const TextRun run = run_latch(fmt::format(R"({{"type": "dynamics", "method": "{}", "until": 1.5, "every": 1.5,
                                                   "events": [{}, {}, {{"name": "seen", "when": "b.y", "value": "h"}}]}})",
                                              methods[seed % 7], on, off),
                                  height, speed);
    if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
    if (names_of_events(run) != std::vector<std::string>{"on", "seen", "off"})
      return fmt::format("{} events", events_of(run).size());
    const double error = std::abs(run.last("b.y") - (height - g * 0.25 / 2));
    return error < 1e-7 ? "" : fmt::format("{} m off", error);
  });
}

TEST(LatchedMotions, ACaughtMassMayPassAfterwards) {
  // It is let go upwards by a blow: the height is passed on the way back, once.
  const TextRun run = run_latch(fmt::format(
      R"({{"type": "dynamics", "until": 2, "every": 2, "events": [{}, {},
                       {{"name": "blow", "when": "t", "value": 1, "impulse": {{"i": "b", "value": [0, 2]}}}},
                       {{"name": "seen", "when": "b.y", "value": "h"}},
                       {{"name": "down", "when": "b.y", "value": "h", "direction": "down"}}]}})",
      R"({"name": "on", "when": "=b.y - h - 0*t", "action": "engage", "element": "latch", "direction": "up"})", off));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(names_of_events(run), (std::vector<std::string>{"on", "seen", "off", "blow", "seen", "down"}));
  EXPECT_NEAR(run.last("b.y"), 0.5 + 2 - g / 2, 1e-7);
}

TEST(LatchedMotions, AMotionCutInTwoIsTheWholeOne) {
  const std::string part = R"({{"type": "dynamics", "until": {}, "every": {}, "events": [{}]}})";
  const std::string check = R"(, {"type": "check"})";
  for (const auto& [first, between, second] : {std::tuple(on, std::string(), on + ", " + off),
                                               {on + ", " + off, "", on + ", " + off},
                                               {on, check, off},
                                               {on + ", " + off, check, on + ", " + off}}) {
    const TextRun run = run_latch(fmt::format(fmt::runtime(part), 0.8, 0.8, first) + between + ", " +
                                  fmt::format(fmt::runtime(part), 1.5, 1.5, second));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const std::size_t last = run.outcome.analyses.size() - 1;
    EXPECT_NEAR(run.last("b.y", last), 0.5 - g * 0.25 / 2, 1e-7);
    EXPECT_TRUE(run.analysis(last).report.warnings.empty());
  }
  // From the given configuration all begins anew.
  const TextRun anew =
      run_latch(fmt::format(fmt::runtime(part), 0.8, 0.8, on) +
                fmt::format(R"(, {{"type": "dynamics", "from": "initial", "until": 0.1, "events": [{}]}})", on));
  ASSERT_EQ(anew.outcome.exit_code, 0) << anew.outcome.error_text;
  EXPECT_NEAR(anew.last("b.vy", 1), 4 - g * 0.1, 1e-7);
}

// A lock that closes after two turns holds the wheel there, in the motions that follow too, with events and without.
TEST(LatchedMotions, ALockHoldsAfterWholeTurns) {
  const std::string lock =
      R"({"name": "on", "when": "w.angle", "value": 12.566370614359172, "action": "engage", "element": "lock"})";
  const TextRun run = run_text(fmt::format(R"({{"catena": 1,
    "bodies": {{"w": {{"mass": 1, "inertia": 1, "position": [0, 0], "angular_velocity": 10}}}},
    "constraints": [{{"type": "revolute", "i": "ground", "j": "w", "at": [0, 0]}},
                    {{"type": "absolute_angle", "name": "lock", "i": "w", "value": 0}}],
    "forces": [{{"type": "torque", "i": "w", "torque": 1}}],
    "outputs": ["w.angle"],
    "analyses": [{{"type": "dynamics", "until": 2, "every": 1, "events": [{0}]}},
                 {{"type": "dynamics", "until": 3, "every": 1, "events": [{0},
                   {{"name": "off", "when": "t", "value": 3.5, "action": "release", "element": "lock"}}]}},
                 {{"type": "dynamics", "until": 4, "every": 1}},
                 {{"type": "dynamics", "until": 6, "every": 1, "events": [{0},
                   {{"name": "off", "when": "t", "value": 5, "action": "release", "element": "lock"}}]}}]}})",
                                           lock));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double there = 4 * std::acos(-1.0);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(run.last("w.angle", k), there, 1e-9) << k;
    EXPECT_NEAR(run.column("w.angle", k).at(k == 0 ? 2 : 0), there, 1e-9) << k;
  }
  EXPECT_NEAR(run.last("w.angle", 3), there + 0.5, 1e-7);
}

// So does a driver that hands over to a lock, in motions that are driven.
TEST(LatchedMotions, ALockHoldsDrivenMotionsAfterWholeTurns) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"w": {"position": [0, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "w", "at": [0, 0]},
                    {"type": "absolute_angle", "name": "lock", "i": "w", "value": 0}],
    "drivers": [{"type": "absolute_angle", "name": "turn", "i": "w", "value": {"polynomial": [0, 7]}}],
    "outputs": ["w.angle"],
    "analyses": [{"type": "kinematics", "until": 2, "every": 1, "events": [
      {"name": "off", "when": "w.angle", "value": 12.566370614359172, "action": "release", "element": "turn"},
      {"name": "on", "when": "w.angle", "value": 12.566370614359172, "action": "engage", "element": "lock"}]},
     {"type": "kinematics", "until": 3, "every": 0.5}, {"type": "inverse_dynamics", "at": 3.5}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(run.last("w.angle", k), 4 * std::acos(-1.0), 1e-9) << k;
  EXPECT_NEAR(run.first("w.angle", 1), 4 * std::acos(-1.0), 1e-9);
}

// The same motions one after the other inside a sweep.
TEST(LatchedMotions, ASweepHoldsWhatItsMotionsHave) {
  const TextRun run = run_latch(fmt::format(R"({{"type": "sweep", "over": {{"h": [0.4, 0.5]}}, "of": [
    {{"type": "dynamics", "until": 0.8, "events": [{0}]}}, {{"type": "assemble"}},
    {{"type": "dynamics", "until": 1.5, "events": [{0}, {1}], "measures": {{"y": {{"final": "b.y"}}}}}}]}})",
                                            on, off));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> y = run.column("y");
  ASSERT_EQ(y.size(), 2U);
  EXPECT_NEAR(y[0], 0.4 - g * 0.25 / 2, 1e-7);
  EXPECT_NEAR(y[1], 0.5 - g * 0.25 / 2, 1e-7);
}

TEST(LatchedMotions, GradientsGoOnAfterTheRelease) {
  const TextRun run = run_latch(fmt::format(R"({{"type": "sensitivity", "parameters": ["h", "v"],
    "of": {{"type": "dynamics", "until": 1.5, "every": 1.5, "measures": {{"y": {{"final": "b.y"}}}},
            "events": [{}, {}]}}}})",
                                            on, off));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double>& gradient = run.analysis().measures.at(0).gradient;
  ASSERT_EQ(gradient.size(), 2U);
  EXPECT_NEAR(gradient[0], 1, 1e-7);
  EXPECT_NEAR(gradient[1], 0, 1e-7);
}

// A mass on a spring that is caught at h and let go at 1: y = h cos(w (t - 1)) from then on, w^2 = k / m, whatever the
// speed was. The event and the constraint have the same value: nothing opens where the other parameters move the
// instant.
TEST(LatchedMotions, GradientsOfASpringGoOnAfterTheRelease) {
  expect_no_fault(1, size_of_test(12u, 4u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double m = random(0.5, 2), k = random(10, 40), speed = random(1.5, 3), w = std::sqrt(k / m);
    const double h = speed / w * random(0.2, 0.8), later = 0.7, phase = w * later;
    const TextRun run = run_text(fmt::format(R"({{"catena": 1,
      "parameters": {{"m": {}, "k": {}, "h": {}, "v": {}}},
      "bodies": {{"b": {{"mass": "m", "particle": true, "position": [0, 0], "velocity": [0, "v"]}}}},
      "constraints": [{{"type": "absolute_x", "i": "b", "value": 0}},
                      {{"type": "absolute_y", "name": "latch", "i": "b", "value": "h"}}],
      "forces": [{{"type": "spring_damper", "i": "ground", "j": "b", "k": "k", "length": 0}}],
      "analyses": [{{"type": "sensitivity", "parameters": ["m", "k", "h", "v"],
        "of": {{"type": "dynamics", "tolerance": 1e-10, "until": {}, "every": 1, "events": [{}, {}],
                "measures": {{"y": {{"final": "b.y"}}}}}}}}]}})",
                                             m, k, h, speed, 1 + later, on, off));
    if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
    const std::vector<double>& found = run.analysis().measures.at(0).gradient;
    const double by_w = -h * later * std::sin(phase);
    const double right[] = {-by_w * w / (2 * m), by_w * w / (2 * k), std::cos(phase), 0};
    for (std::size_t p = 0; p < 4; ++p) {
      if (!(std::abs(found.at(p) - right[p]) < 1e-7)) return fmt::format("by {}: {}, not {}", p, found[p], right[p]);
    }
    return {};
  });
}

// What lies on the floor at the watched height has not been below it when it is kicked up.
TEST(LatchedMotions, WhatLiesAtItsValueHasNotPassedIt) {
  for (const char* direction : {"up", "any"}) {
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
      "bodies": {{"b": {{"mass": 1, "particle": true, "position": [0, 1.1]}}}},
      "constraints": [{{"type": "absolute_x", "i": "b", "value": 0}}],
      "forces": [{{"type": "contact", "name": "floor", "i": "ground", "j": "b", "radius": 0.1,
                   "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}],
      "outputs": ["b.y"],
      "analyses": [{{"type": "dynamics", "until": 1.2, "every": 1.2, "events": [
        {{"name": "passed", "when": "b.y", "value": 0.1, "direction": "{}"}},
        {{"name": "kick", "when": "t", "value": 1, "impulse": {{"i": "b", "value": [0, 2]}}}}]}}]}})",
                                             direction));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    for (const EventEntry& event : events_of(run)) EXPECT_TRUE(event.name != "passed" || event.t < 0.999) << direction;
    EXPECT_NEAR(run.last("b.y"), 0.1 + 2 * 0.2 - g * 0.04 / 2, 1e-7);
  }
}

// A wheel is locked two turns on, and springs count them: they hold the arm between both at two thirds of the wheel's
// angle. What follows starts from there.
TEST(LatchedMotions, WhatRestsAfterALockKeepsTheTurns) {
  const TextRun run = run_text(fmt::format(R"({{"catena": 1, "bodies": {{
      "w": {{"mass": 1, "inertia": 100, "angular_velocity": 10}}, "a": {{"mass": 1, "inertia": 100}}}},
    "constraints": [{{"type": "revolute", "i": "ground", "j": "w"}}, {{"type": "revolute", "i": "ground", "j": "a"}},
                    {{"type": "absolute_angle", "name": "lock", "i": "w", "value": 0.5}}],
    "forces": [{{"type": "torsion_spring", "i": "w", "j": "a", "k": 2, "angle": 0}},
               {{"type": "torsion_spring", "i": "ground", "j": "a", "k": 1, "angle": 0}}],
    "outputs": ["w.angle", "a.angle"],
    "analyses": [{{"type": "dynamics", "until": 3, "events": [
        {{"name": "e", "when": "w.angle", "value": {}, "action": "engage", "element": "lock"}}]}},
      {{"type": "equilibrium"}}, {{"type": "assemble"}}, {{"type": "dynamics", "until": 4}}]}})",
                                           0.5 + 4 * std::numbers::pi));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  ASSERT_EQ(run.outcome.analyses.size(), 4U);
  for (const std::size_t k : {1U, 2U, 3U}) {
    SCOPED_TRACE(k);
    EXPECT_NEAR(run.last("w.angle", k), 0.5 + 4 * std::numbers::pi, 1e-9);
    if (k < 3) {
      EXPECT_NEAR(run.last("a.angle", k), (1 + 8 * std::numbers::pi) / 3, 1e-9);
    }
  }
}

// A pinion meshes with its rack after two turns without it, and the rack's spring is slack where it is then.
TEST(LatchedMotions, ARackRestsWhereThePinionHasMetIt) {
  const TextRun run = run_text(fmt::format(R"({{"catena": 1, "bodies": {{
      "p": {{"mass": 1, "inertia": 1, "position": [0, 0.1], "angular_velocity": -10}},
      "r": {{"mass": 1, "inertia": 1}}}},
    "constraints": [{{"type": "revolute", "i": "ground", "j": "p", "at": [0, 0.1]}},
                    {{"type": "translational", "i": "ground", "j": "r", "axis_i": [1, 0]}},
                    {{"type": "rack_pinion", "name": "mesh", "i": "r", "j": "p", "axis_i": [1, 0], "radius": 0.1}}],
    "forces": [{{"type": "spring_damper", "i": ["ground", [-10, 0]], "j": "r", "k": 100, "length": 10}}],
    "outputs": ["p.angle", "r.x"],
    "analyses": [{{"type": "dynamics", "until": 3, "events": [
        {{"name": "e", "when": "p.angle", "value": {}, "action": "engage", "element": "mesh"}}]}},
      {{"type": "equilibrium"}}]}})",
                                           -4 * std::numbers::pi));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("p.angle", 1), -4 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(run.last("r.x", 1), 0, 1e-9);
}

// A driver hands a wheel over to a hold at one radian, and the hold to a driver that turns it back.
TEST(LatchedMotions, DriversThatHandOver) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"b": {"position": [0, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "b", "at": [0, 0]},
                    {"type": "absolute_angle", "name": "hold", "i": "b", "value": 1}],
    "drivers": [{"type": "absolute_angle", "name": "there", "i": "b", "value": {"polynomial": [0, 1]}},
                {"type": "absolute_angle", "name": "back", "i": "b", "value": {"polynomial": [3, -1]}}],
    "outputs": ["b.angle", "b.omega"],
    "analyses": [{"type": "kinematics", "until": 2.5, "every": 0.5, "events": [
      {"name": "e1", "when": "b.angle", "value": 1, "action": "release", "element": "there"},
      {"name": "e2", "when": "b.angle", "value": 1, "action": "engage", "element": "hold"},
      {"name": "e3", "when": "t", "value": 2, "action": "release", "element": "hold"},
      {"name": "e4", "when": "t", "value": 2, "action": "engage", "element": "back"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_EQ(names_of_events(run), (std::vector<std::string>{"e1", "e2", "e3", "e4"}));
  EXPECT_NEAR(run.last("b.angle"), 0.5, 1e-12);
  EXPECT_NEAR(run.last("b.omega"), -1, 1e-12);
}

}  // namespace
}  // namespace catena::testing
