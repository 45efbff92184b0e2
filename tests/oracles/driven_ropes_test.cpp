// Ropes in motions that drivers determine: they are watched where these do so alone, and hold the load where they do
// not. Closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "oracles/good_run.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;

bool says(const TextRun& run, const std::string& words) {
  for (const std::string& warning : run.analysis().report.warnings) {
    if (warning.find(words) != std::string::npos) return true;
  }
  return false;
}

/// A drum of radius r, driven by  angle = w t + b t^2 / 2  (times `side`), winds a rope on which a guided load hangs.
struct Hoist {
  double m, r, inertia, w, b, t;
  int side;

  std::string scene(const std::string& analysis, const std::string& keys = "") const {
    const bool loads = analysis != "kinematics";
    return fmt::format(
        R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{
          "load": {{"particle": true, "mass": {0:.17g}, "position": [{1:.17g}, -20]}},
          "drum": {{"mass": 2, "inertia": {2:.17g}}}}},
        "constraints": [{{"type": "revolute", "i": "ground", "j": "drum"}},
          {{"type": "absolute_x", "i": "load", "value": {1:.17g}}}],
        "drivers": [{{"type": "absolute_angle", "name": "drive", "i": "drum",
          "value": {{"polynomial": [0, {3:.17g}, {4:.17g}]}}}}],
        "forces": [{{"type": "rope", "name": "rope", "i": "load",
          "over": [{{"at": "drum", "radius": {5:.17g}, "pulley": "rolls", "side": {6}}}], "j": "drum"}}],
        "outputs": ["load.y", "load.vy", "load.ay", "rope.gap"{7}],
        "analyses": [{{"type": "{8}", "until": {9:.17g}, "every": {9:.17g}{10}}}]}})",
        m, side * r, inertia, side * w, side * b / 2, r, side, loads ? R"(, "rope.force", "drive.load")" : "", analysis,
        t, keys);
  }
};

TEST(DrivenRopes, HoistsHoldTheirLoads) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Hoist hoist{};
    hoist.m = random(1, 5);
    hoist.r = random(0.02, 0.1);
    hoist.inertia = random(0.001, 0.1);
    hoist.w = random(-20, 40);
    // The load falls more slowly than by itself.
    hoist.b = random(-0.9, 2) * g / hoist.r;
    hoist.t = random(0.2, 1);
    hoist.side = seed % 2 == 0 ? 1 : -1;
    const double turned = hoist.w * hoist.t + hoist.b * hoist.t * hoist.t / 2;
    for (const char* analysis : {"kinematics", "inverse_dynamics"}) {
      const TextRun run = good_run(hoist.scene(analysis));
      EXPECT_NEAR(run.last("load.y"), -20 + hoist.r * turned, 1e-10);
      EXPECT_NEAR(run.last("load.vy"), hoist.r * (hoist.w + hoist.b * hoist.t), 1e-10);
      EXPECT_NEAR(run.last("load.ay"), hoist.r * hoist.b, 1e-9);
      EXPECT_NEAR(run.last("rope.gap"), 0, 1e-12);
      EXPECT_TRUE(says(run, "\"rope\" is taken to stay taut"));
      EXPECT_FALSE(says(run, "would have to push"));
      if (analysis[0] == 'k') continue;
      const double tension = hoist.m * (g + hoist.r * hoist.b);
      EXPECT_NEAR(run.last("rope.force"), tension, 1e-9);
      EXPECT_NEAR(run.last("drive.load"), hoist.side * (hoist.r * tension + hoist.inertia * hoist.b), 1e-9);
    }
  }
}

// A drum that gives way faster than the load falls: the rope would have to push.
TEST(DrivenRopes, RopesThatWouldPushAreTold) {
  const Hoist hoist{.m = 2, .r = 0.1, .inertia = 0.01, .w = 0, .b = -1.5 * g / 0.1, .t = 0.5, .side = 1};
  EXPECT_TRUE(says(good_run(hoist.scene("inverse_dynamics")), "would have to push, by up to 9.81 N"));
  // In motion the load falls by itself.
  const TextRun run = good_run(hoist.scene("dynamics"));
  EXPECT_NEAR(run.last("load.y"), -20 - g * hoist.t * hoist.t / 2, 1e-7);
}

// A wheel that a table drives from rest, its rate zero but for rounding, beside a rack, a pinion and a rope whose rows
// depend on each other: where their ranks are looked for, the table is not asked for.
TEST(DrivenRopes, TablesThatBeginAtRestAreNotLeft) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10], "bodies": {
    "w1": {"mass": 0.5, "inertia": 0, "angle": -0.1}, "w2": {"mass": 2, "inertia": 0},
    "load": {"particle": true, "mass": 3, "position": [0.1, -5]},
    "rack": {"mass": 1, "inertia": 0.1, "position": [-0.2, 0.2], "angle": -3}}, "constraints": [
    {"type": "revolute", "i": "ground", "j": "w1"},
    {"type": "revolute", "i": ["ground", [-0.04888109690564071, -0.0247553321234035]], "j": "w2"},
    {"type": "absolute_x", "i": "load"},
    {"type": "translational", "i": ["ground", [-0.19481359685319077, 0.21388816720837428]],
      "axis_i": [-0.85313, -0.5217], "j": "rack", "axis_j": [1, 0]},
    {"type": "rack_pinion", "i": "rack", "axis_i": [1, 0], "j": "w2", "radius": 0.27972667787370215, "side": 1}],
    "drivers": [{"type": "absolute_angle", "i": "w1", "value": {"spline": {"t": [0, 0.4, 1, 1.1, 2],
      "value": [-0.07956344350289335, 1, -1, -1, 0.2], "end": "clamped"}}}],
    "forces": [{"type": "rope", "i": ["w2", [-0.1, 0.1]], "over": [{"at": "w2", "radius": 0.1, "side": -1,
      "pulley": "rolls"}], "j": "load"}],
    "outputs": ["w1.angle"], "analyses": [{"type": "dynamics", "at": [0.4, 1]}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  const auto angle = run.column("w1.angle");
  EXPECT_NEAR(angle[0], 1, 1e-12);
  EXPECT_NEAR(angle[1], -1, 1e-12);
}

// Two ropes on one load: which of them is taut is a question of forces, and the motion is not determined as before.
TEST(DrivenRopes, RopesTooManyDetermineNothing) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
      "a": {"particle": true, "mass": 1, "position": [0, -1]}},
    "constraints": [{"type": "absolute_x", "i": "a", "value": 0}],
    "forces": [{"type": "cable", "i": "ground", "j": "a"}, {"type": "cable", "i": ["ground", [0, 0.5]], "j": "a"}],
    "analyses": [{"type": "kinematics", "until": 1, "every": 1}]})");
  ASSERT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::under_driven);
}

// What is driven regardless of a rope shows how far it would have to stretch; an elastic one pulls.
TEST(DrivenRopes, DriversThatMoveOnRegardless) {
  const auto lifted = [](const std::string& more, const std::string& analysis) {
    return good_run(R"({"catena": 1, "bodies": {"a": {"particle": true, "mass": 2, "position": [0.1, -1]}},
      "constraints": [{"type": "absolute_x", "i": "a"}],
      "drivers": [{"type": "absolute_y", "name": "drive", "i": "a", "value": {"polynomial": [-1, -0.5]}}],
      "forces": [{"type": "rope", "name": "rope", "i": ["ground", [-0.1, -1]],
        "over": [{"at": ["ground", [0, 0]], "radius": 0.1}], "j": "a")" +
                    more + R"(}], "outputs": ["rope.gap", "rope.length")" +
                    (analysis == "kinematics" ? "" : R"(, "rope.force", "drive.load")") +
                    R"(], "analyses": [{"type": ")" + analysis + R"(", "until": 1, "every": 1}]})");
  };
  const TextRun plain = lifted("", "kinematics");
  EXPECT_NEAR(plain.last("rope.gap"), -0.5, 1e-12);
  EXPECT_NEAR(plain.last("rope.length"), 2.5 + 0.1 * pi, 1e-12);
  ASSERT_EQ(plain.analysis().report.warnings.size(), 1u);
  EXPECT_NE(plain.analysis().report.warnings[0].find("rope \"rope\" is violated"), std::string::npos);
  const TextRun elastic = lifted(R"(, "k": 100)", "inverse_dynamics");
  EXPECT_NEAR(elastic.last("rope.force"), 50, 1e-10);
  EXPECT_NEAR(elastic.last("drive.load"), -50, 1e-10);
}

}  // namespace
}  // namespace catena::testing
