// Equilibria of scenes as users write them: spring networks, loaded linkages, holding loads, redundant supports,
// unstable starts; each against a closed form. What is refused names what is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// One equilibrium of a scene; `rest` holds bodies, constraints, ... and outputs.
TextRun settle(const std::string& rest, const std::string& keys = "", const std::string& gravity = "[0, -10]") {
  return run_text(R"({"catena": 1, "gravity": )" + gravity + ", " + rest + R"(, "analyses": [{"type": "equilibrium")" +
                  keys + "}]}");
}

void expect_stable(const TextRun& run) {
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  ASSERT_EQ(run.outcome.analyses.size(), 1u);
  EXPECT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_TRUE(field<bool>(run, "stable"));
  EXPECT_EQ(field<std::int64_t>(run, "negative_modes"), 0);
}

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts) {
    if (text.find(part) != std::string::npos) return true;
  }
  return false;
}

double bisect(double low, double high, const auto& function) {
  for (int k = 0; k < 200; ++k) {
    const double middle = (low + high) / 2;
    (function(middle) > 0 ? high : low) = middle;
  }
  return (low + high) / 2;
}

TEST(EquilibriumScenes, AMassBetweenFourSpringsOfNoLength) {
  const TextRun run = settle(R"("bodies": {"knot": {"particle": true, "mass": 3, "position": [0.2, 0.1]}},
    "forces": [{"type": "spring_damper", "i": ["ground", [0, 0]], "j": "knot", "k": 100, "length": 0},
      {"type": "spring_damper", "i": ["ground", [2, 0]], "j": "knot", "k": 200, "length": 0},
      {"type": "spring_damper", "name": "far", "i": ["ground", [2, 1]], "j": "knot", "k": 300, "length": 0},
      {"type": "spring_damper", "i": ["ground", [0, 1]], "j": "knot", "k": 400, "length": 0}],
    "outputs": ["knot.x", "knot.y", "far.force"])");
  expect_stable(run);
  const double x = 2 * 500 / 1000.0, y = (700 - 30) / 1000.0;
  EXPECT_NEAR(run.last("knot.x"), x, 1e-13);
  EXPECT_NEAR(run.last("knot.y"), y, 1e-13);
  EXPECT_NEAR(run.last("far.force"), 300 * std::hypot(2 - x, 1 - y), 1e-10);
}

TEST(EquilibriumScenes, ALadderOfTwentySpringsStretchesUnderItsWeights) {
  const TextRun run = settle(R"("replicate": [{"count": 20, "bodies":
      {"m{k}": {"particle": true, "mass": 0.5, "position": ["=0.01*k", "=-k"]}},
      "forces": [{"type": "spring_damper", "i": "m{k-1}", "j": "m{k}", "k": 80, "length": 1}]}],
    "bodies": {"m0": {"fixed": true}}, "outputs": ["m20.x", "m20.y"])");
  expect_stable(run);
  EXPECT_NEAR(run.last("m20.x"), 0, 1e-12);
  // Spring k carries 21 - k masses.
  EXPECT_NEAR(run.last("m20.y"), -20 - 210 * 5 / 80.0, 1e-11);
}

TEST(EquilibriumScenes, ADriverHoldsACrankUp) {
  const TextRun run = settle(R"("bodies": {"crank": {"mass": 3, "rod": {"from": [0, 0], "to": [0.5, 0]}}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "crank.from"}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, 2]}}],
    "outputs": ["crank.angle", "drive.load", "O.fx", "O.fy"])",
                             R"(, "at": 0.25)");
  expect_stable(run);
  EXPECT_NEAR(run.last("crank.angle"), 0.5, 1e-13);
  EXPECT_NEAR(run.last("drive.load"), 7.5 * std::cos(0.5), 1e-12);
  EXPECT_NEAR(run.last("O.fy"), 30, 1e-12);
  EXPECT_NEAR(run.last("O.fx"), 0, 1e-12);
}

TEST(EquilibriumScenes, AToggleSnapsThroughAgainstItsSpring) {
  // Two massless links of 1 m, 50 N down on the knee, a spring of 400 N/m behind the slider: free at x = 1.9.
  const TextRun run = settle(R"("bodies": {"a": {"mass": 0, "inertia": 0, "rod": {"from": [0, 0], "to": [0.95, 0.3]}},
      "b": {"mass": 0, "inertia": 0, "rod": {"from": [0.95, 0.3], "to": [1.9, 0]}},
      "slider": {"mass": 1, "inertia": 1, "position": [1.9, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": ["a", [-0.5, 0]]},
      {"type": "revolute", "name": "knee", "i": ["a", [0.5, 0]], "j": ["b", [-0.5, 0]]},
      {"type": "revolute", "i": ["b", [0.5, 0]], "j": "slider"},
      {"type": "translational", "name": "guide", "i": "ground", "j": "slider", "axis_i": [1, 0], "axis_j": [1, 0]}],
    "forces": [{"type": "point_force", "i": ["a", [0.5, 0]], "force": [0, -50]},
      {"type": "spring_damper", "name": "spring", "i": "slider", "j": ["ground", [4, 0]], "k": 400, "length": 2.1}],
    "outputs": ["slider.x", "spring.force", "knee.fy"])",
                             "", "[0, 0]");
  expect_stable(run);
  // Too weak a spring: the knee goes through. Below, each link pulls with 25 N / sin(angle), x = 2 cos(angle).
  const double angle = bisect(0.32, 1.5, [](double t) { return 400 * (1.9 - 2 * std::cos(t)) - 25 / std::tan(t); });
  EXPECT_NEAR(run.last("slider.x"), 2 * std::cos(angle), 1e-11);
  EXPECT_NEAR(run.last("knee.fy"), -25, 1e-9);
  EXPECT_NEAR(run.last("spring.force"), 25 / std::tan(angle), 1e-9);
}

TEST(EquilibriumScenes, ASledgeOnASlopeHangsOnItsSpring) {
  const TextRun run = settle(R"("bodies": {"sledge": {"mass": 2, "inertia": 1, "position": [0.3, 0.3]}},
    "constraints": [{"type": "translational", "name": "rail", "i": "ground", "j": "sledge", "axis_i": [1, 1],
      "axis_j": [1, 1]}],
    "forces": [{"type": "spring_damper", "name": "rope", "i": ["ground", [3, 3]], "j": "sledge", "k": 50, "length": 1}],
    "outputs": ["sledge.x", "rope.force", "rail.fx", "rail.fy"])");
  expect_stable(run);
  const double pull = 20 * std::sin(pi / 4);
  EXPECT_NEAR(run.last("rope.force"), pull, 1e-11);
  EXPECT_NEAR(run.last("sledge.x"), 3 - (1 + pull / 50) / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(std::hypot(run.last("rail.fx"), run.last("rail.fy")), pull, 1e-11);
}

TEST(EquilibriumScenes, ABeadComesToRestAtTheBottomOfItsHoop) {
  for (const char* place : {"[0.6, 0.8]", "[0, 1]"}) {
    const TextRun run = settle(std::string(R"("bodies": {"bead": {"particle": true, "mass": 2, "position": )") + place +
                               R"(}}, "constraints": [{"type": "absolute_distance", "name": "hoop", "i": "bead",
      "ground": [0, 0], "value": 1}], "outputs": ["bead.x", "bead.y", "hoop.fy"])");
    expect_stable(run);
    EXPECT_NEAR(run.last("bead.x"), 0, 1e-10) << place;
    EXPECT_NEAR(run.last("bead.y"), -1, 1e-12) << place;
    EXPECT_NEAR(run.last("hoop.fy"), 20, 1e-9) << place;
  }
}

TEST(EquilibriumScenes, GearsHoldATorqueAgainstASpring) {
  const TextRun run = settle(R"("bodies": {"a": {"mass": 1, "inertia": 1},
      "b": {"mass": 1, "inertia": 1, "position": [0.5, 0]}},
    "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "a"},
      {"type": "revolute", "name": "B", "i": ["ground", [0.5, 0]], "j": "b"},
      {"type": "gear", "name": "mesh", "i": "a", "j": "b", "radius_i": 0.1, "radius_j": 0.4}],
    "forces": [{"type": "torque", "i": "a", "torque": 3},
      {"type": "torsion_spring", "i": "ground", "j": "b", "k": 60, "angle": 0}],
    "outputs": ["a.angle", "b.angle", "A.fy"])",
                             "", "[0, 0]");
  expect_stable(run);
  // 3 N m on the small wheel is 12 N m on the large one, which turns the other way.
  EXPECT_NEAR(run.last("b.angle"), -12 / 60.0, 1e-12);
  EXPECT_NEAR(run.last("a.angle"), 0.8, 1e-12);
  EXPECT_NEAR(std::abs(run.last("A.fy")), 3 / 0.1, 1e-10);
}

TEST(EquilibriumScenes, ABeamPinnedTwiceGetsTheLeastReactions) {
  const TextRun run = settle(R"("bodies": {"beam": {"mass": 6, "rod": {"from": [0, 0], "to": [3, 0]}}},
    "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "beam.from"},
      {"type": "revolute", "name": "B", "i": ["ground", [3, 0]], "j": "beam.to"}],
    "forces": [{"type": "point_force", "i": ["beam", [-0.5, 0]], "force": [12, -30]}],
    "outputs": ["A.fx", "A.fy", "B.fx", "B.fy"])");
  expect_stable(run);
  // Along the beam only the sum is known: the least squares are halves. Across it statics decides.
  EXPECT_NEAR(run.last("A.fx"), -6, 1e-10);
  EXPECT_NEAR(run.last("B.fx"), -6, 1e-10);
  EXPECT_NEAR(run.last("A.fy"), 30 + 20, 1e-10);
  EXPECT_NEAR(run.last("B.fy"), 30 + 10, 1e-10);
  EXPECT_TRUE(mentions(run.analysis().report.warnings, "not unique"));
  EXPECT_TRUE(mentions(run.analysis().report.warnings, "\"A\", \"B\""));
  EXPECT_FALSE(run.analysis().report.redundant.empty());
}

TEST(EquilibriumScenes, ThreeEqualCranksHangDownAndShareTheCoupler) {
  const TextRun run = settle(R"("bodies": {"coupler": {"mass": 4, "rod": {"from": [0.6, -0.8], "to": [2.6, -0.8]}}},
    "replicate": [{"count": 3, "bodies": {"c{k}": {"mass": 0, "inertia": 0,
        "rod": {"from": ["=k-1", 0], "to": ["=k-1+0.6", -0.8]}}},
      "constraints": [{"type": "revolute", "name": "A{k}", "i": ["ground", ["=k-1", 0]], "j": "c{k}.from"},
        {"type": "revolute", "name": "B{k}", "i": "c{k}.to", "j": ["coupler", ["=k-2", 0]]}]}],
    "outputs": ["coupler.x", "coupler.y", "A1.fy", "A2.fy", "A3.fy"])");
  expect_stable(run);
  EXPECT_NEAR(run.last("coupler.x"), 1, 1e-9);
  EXPECT_NEAR(run.last("coupler.y"), -1, 1e-12);
  for (const char* name : {"A1.fy", "A2.fy", "A3.fy"}) EXPECT_NEAR(run.last(name), 40 / 3.0, 1e-9) << name;
  EXPECT_EQ(run.analysis().report.dof, 1);
}

TEST(EquilibriumScenes, ADoublePendulumFallsFromStandingOnItsHead) {
  const std::string scene = R"("bodies": {"a": {"mass": 1, "rod": {"from": [0, 0], "to": [0, 1]}},
      "b": {"mass": 1, "rod": {"from": [0, 1], "to": [0, 2]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"}],
    "outputs": ["b.x", "b.y"])";
  const TextRun run = settle(scene);
  expect_stable(run);
  EXPECT_NEAR(run.last("b.x"), 0, 1e-9);
  EXPECT_NEAR(run.last("b.y"), -1.5, 1e-12);
  EXPECT_TRUE(mentions(run.analysis().report.warnings, "no minimum"));
  const TextRun stays = settle(scene, R"(, "accept": "stationary")");
  EXPECT_EQ(stays.outcome.exit_code, 0);
  EXPECT_FALSE(field<bool>(stays, "stable"));
  EXPECT_EQ(field<std::int64_t>(stays, "negative_modes"), 2);
  EXPECT_NEAR(stays.last("b.y"), 1.5, 1e-12);
  EXPECT_TRUE(mentions(stays.analysis().report.warnings, "unstable"));
}

TEST(EquilibriumScenes, AColumnOnASpringBucklesBeyondItsLoad) {
  // Two rigid links of 1 m, a torsion spring of 100 N m/rad at the knee, guided ends: both tilt by theta, V = k (2
  // theta)^2 / 2 + 2 P cos(theta): 2 k theta = P sin(theta), critical P = 2 k / l = 200 N.
  for (const double load : {150.0, 260.0}) {
    const TextRun run =
        settle(R"("parameters": {"P": )" + std::to_string(load) +
                   R"(}, "bodies": {"a": {"mass": 0, "inertia": 0, "rod": {"from": [0, 0], "to": [0, 1]}},
      "b": {"mass": 0, "inertia": 0, "rod": {"from": [0, 1], "to": [0, 2]}}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"},
      {"type": "absolute_x", "i": "b.to", "value": 0}],
    "forces": [{"type": "torsion_spring", "i": "a", "j": "b", "k": 100, "angle": 0},
      {"type": "point_force", "i": "b.to", "force": [0, "=-P"]}], "outputs": ["a.angle", "b.angle", "b.y"])",
               "", "[0, 0]");
    expect_stable(run);
    const double tilt = load < 200 ? 0 : bisect(0.1, 3, [&](double t) { return 200 * t - load * std::sin(t); });
    EXPECT_NEAR(std::abs(run.last("a.angle") - pi / 2), tilt, 1e-8) << load;
    EXPECT_NEAR(run.last("a.angle") + run.last("b.angle"), pi, 1e-8) << load;
  }
}

TEST(EquilibriumScenes, ACraneTrussCarriesItsLoad) {
  // Pins, couplers without mass: a load of 100 N at (2, 1) on a tie to (0, 1) and a strut to (0, 0).
  const TextRun run = settle(R"("bodies": {"tip": {"particle": true, "mass": 10, "position": [2, 1]}},
    "constraints": [{"type": "coupler", "name": "tie", "i": ["ground", [0, 1]], "j": "tip", "value": 2},
      {"type": "coupler", "name": "strut", "i": "ground", "j": "tip", "value": 2.23606797749979}],
    "outputs": ["tie.fx", "tie.fy", "strut.fx", "strut.fy"])");
  expect_stable(run);
  EXPECT_NEAR(run.last("strut.fx"), 200, 1e-10);
  EXPECT_NEAR(run.last("strut.fy"), 100, 1e-10);
  EXPECT_NEAR(run.last("tie.fx"), -200, 1e-10);
  EXPECT_NEAR(run.last("tie.fy"), 0, 1e-10);
}

TEST(EquilibriumScenes, ARackSettlesBetweenItsWeightAndAPinionSpring) {
  const TextRun run = settle(R"("bodies": {"rack": {"mass": 2, "inertia": 1, "position": [0.1, 0]},
      "pinion": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "pinion"},
      {"type": "translational", "i": ["ground", [0.1, 0]], "j": "rack", "axis_i": [0, 1], "axis_j": [0, 1]},
      {"type": "rack_pinion", "i": "rack", "j": "pinion", "axis_i": [0, 1], "radius": 0.1, "side": 1}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "pinion", "k": 4, "angle": 0}],
    "outputs": ["rack.y", "pinion.angle"])");
  expect_stable(run);
  // 20 N at 0.1 m: 2 N m on a spring of 4 N m/rad; the rack moves by the radius times the turn.
  EXPECT_NEAR(std::abs(run.last("pinion.angle")), 0.5, 1e-12);
  EXPECT_NEAR(run.last("rack.y"), -0.05, 1e-12);
}

TEST(EquilibriumScenes, WhatFloatsIsNamed) {
  const TextRun pair = settle(R"("bodies": {"a": {"mass": 1, "inertia": 1}, "b": {"mass": 1, "inertia": 1,
      "position": [1, 0]}}, "forces": [{"type": "spring_damper", "i": "a", "j": "b", "k": 10}])",
                              "", "[0, 0]");
  EXPECT_EQ(pair.outcome.exit_code, 1);
  EXPECT_EQ(pair.analysis().report.status, Status::refused);
  EXPECT_NE(pair.analysis().report.message.find("\"a\", \"b\""), std::string::npos) << pair.analysis().report.message;
  EXPECT_NE(pair.analysis().report.message.find("along y and to turn"), std::string::npos);
  const TextRun speck = settle(R"("bodies": {"speck": {"mass": 1, "particle": true}})", "", "[0, 0]");
  EXPECT_EQ(speck.analysis().report.status, Status::refused);
  EXPECT_NE(speck.analysis().report.message.find("\"speck\" is free to move along x and along y: no"),
            std::string::npos)
      << speck.analysis().report.message;
  const TextRun falls = settle(R"("bodies": {"stone": {"mass": 1, "inertia": 1}})");
  EXPECT_EQ(falls.analysis().report.status, Status::unbounded);
  EXPECT_NE(falls.analysis().report.message.find("\"stone\""), std::string::npos);
  const TextRun slides = settle(R"("bodies": {"stone": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "absolute_x", "i": "stone", "value": 0}, {"type": "absolute_angle", "i": "stone", "value": 0}])");
  EXPECT_EQ(slides.analysis().report.status, Status::unbounded);
  EXPECT_NE(slides.analysis().report.message.find("\"stone\""), std::string::npos);
  const TextRun idle = settle(R"("bodies": {"stone": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "absolute_y", "i": "stone", "value": 0}, {"type": "absolute_angle", "i": "stone", "value": 0}])");
  // Every place along x is as good: neutral, and named.
  EXPECT_TRUE(idle.analysis().report.ok()) << idle.analysis().report.message;
  ASSERT_FALSE(idle.analysis().report.warnings.empty());
  EXPECT_NE(idle.analysis().report.warnings[0].find("\"stone\" along (1, 0)"), std::string::npos)
      << idle.analysis().report.warnings[0];
}

TEST(EquilibriumScenes, LinksThatCannotMeetAreNamed) {
  const TextRun run = settle(R"("bodies": {"bar": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}},
    "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "bar.from"},
      {"type": "revolute", "name": "B", "i": ["ground", [3, 0]], "j": "bar.to"}])");
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::not_assembled);
  EXPECT_TRUE(run.analysis().report.message.find("\"A\"") != std::string::npos ||
              run.analysis().report.message.find("\"B\"") != std::string::npos)
      << run.analysis().report.message;
}

}  // namespace
}  // namespace catena::testing
