// Assembly through scenes from rough sketches: with fewer equations than coordinates, and with more.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// Two pendulums on each other, sketched far from their pins and left free to swing.
TEST(AssemblyScene, MechanismsThatAreFreeToMove) {
  const TextRun run = run_text(R"({"catena": 1,
      "bodies": {"upper": {"position": [0.7, 0.2], "angle": 0.3, "points": {"end": [1, 0]}},
                 "lower": {"position": [2, 1], "angle": -0.8}},
      "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "upper"},
                      {"type": "revolute", "name": "A", "i": "upper.end", "j": "lower"}],
      "analyses": [{"type": "assemble"}, {"type": "check"}],
      "outputs": ["upper.x", "upper.y", "upper.end.x", "upper.end.y", "lower.x", "lower.y", "residual"]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("upper.x"), 0, 1e-12);
  EXPECT_NEAR(run.last("upper.y"), 0, 1e-12);
  EXPECT_NEAR(run.last("upper.end.x"), run.last("lower.x"), 1e-12);
  EXPECT_NEAR(run.last("upper.end.y"), run.last("lower.y"), 1e-12);
  EXPECT_NEAR(std::hypot(run.last("lower.x"), run.last("lower.y")), 1, 1e-12);
  EXPECT_LE(run.last("residual"), 1e-12);
  EXPECT_EQ(run.analysis(1).report.dof, 2);
}

// A parallelogram with a third crank, all sketched by eye: one bar more than it needs, twice an equation that repeats.
std::string three_cranks(double third_crank) {
  return R"({"catena": 1, "parameters": {"r": 0.3, "third": )" + std::to_string(third_crank) + R"(},
      "bodies": {"a": {"position": [0.01, 0], "angle": 0.9, "points": {"end": ["r", 0]}},
                 "b": {"position": [0.98, 0.02], "angle": 1.1, "points": {"end": ["r", 0]}},
                 "c": {"position": [2.03, 0], "angle": 1.05, "points": {"end": ["third", 0]}},
                 "bar": {"position": [0.2, 0.25], "angle": 0.05, "points": {"middle": [1, 0], "end": [2, 0]}}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a"},
                      {"type": "revolute", "i": ["ground", [1, 0]], "j": "b"},
                      {"type": "revolute", "i": ["ground", [2, 0]], "j": "c"},
                      {"type": "revolute", "i": "a.end", "j": "bar"},
                      {"type": "revolute", "i": "b.end", "j": "bar.middle"},
                      {"type": "revolute", "name": "last", "i": "c.end", "j": "bar.end"}],
      "drivers": [{"type": "absolute_angle", "name": "drive", "i": "a", "value": {"polynomial": [1, 0.5]}}],
      "analyses": [{"type": "assemble"}, {"type": "kinematics", "until": 1, "every": 0.1}],
      "outputs": ["a.angle", "b.angle", "c.angle", "bar.angle", "bar.end.x", "residual"]})";
}

TEST(AssemblyScene, MechanismsWithMoreEquationsThanTheyNeed) {
  const TextRun run = run_text(three_cranks(0.3));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (const char* crank : {"a.angle", "b.angle", "c.angle"}) {
    EXPECT_NEAR(run.last(crank), 1, 1e-11) << crank;
    EXPECT_NEAR(run.last(crank, 1), 1.5, 1e-11) << crank;
  }
  EXPECT_NEAR(run.last("bar.angle"), 0, 1e-11);
  EXPECT_NEAR(run.last("bar.end.x"), 2 + 0.3 * std::cos(1), 1e-11);
  EXPECT_LE(run.last("residual"), 1e-11);
  EXPECT_FALSE(run.analysis(1).report.redundant.empty());
}

// With a third crank that does not fit there is no configuration, and nothing pretends otherwise.
TEST(AssemblyScene, ContradictionsAreNotAssembled) {
  const TextRun run = run_text(three_cranks(0.32));
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::not_assembled);
  EXPECT_NE(run.analysis().report.message.find("\"last\""), std::string::npos) << run.analysis().report.message;
}

TEST(AssemblyScene, WhatIsHeldIsNamedWhereItIsInTheWay) {
  const auto scene = [](const std::string& hold) {
    return R"({"catena": 1, "bodies": {"a": {"rod": {"from": [0, 0], "to": [1, 0]})" + hold + R"(},
        "b": {"rod": {"from": [1, 0], "to": [2, 0.2]}}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"},
                      {"type": "revolute", "i": ["ground", [1.5, 0.5]], "j": "b.to"}],
      "analyses": [{"type": "assemble"}]})";
  };
  EXPECT_EQ(run_text(scene("")).outcome.exit_code, 0);
  const TextRun held = run_text(scene(R"(, "hold": ["angle"])"));
  EXPECT_EQ(held.analysis().report.status, Status::not_assembled);
  EXPECT_NE(held.analysis().report.message.find("\"hold\" does not let assembly change a.angle"), std::string::npos)
      << held.analysis().report.message;
}

// Turning a body whose points all lie at its centroid weighs by the arms of its own mechanism: an arm and a disc that
// are drawn 0.5 rad off share the correction alike whatever stands beside them, held or moving.
TEST(AssemblyScene, WhatStandsBesideDoesNotChangeWhereItIsAssembled) {
  const auto scene = [](const std::string& bodies, const std::string& constraints) {
    return R"({"catena": 1, "bodies": {"arm": {"position": [0.5, 0]}, "disc": {"position": [1, 0], "angle": 0.5})" +
           bodies + R"(}, "constraints": [
      {"type": "revolute", "name": "O", "i": "ground", "j": ["arm", [-0.5, 0]]},
      {"type": "revolute", "name": "A", "i": ["arm", [0.5, 0]], "j": "disc"},
      {"type": "relative_angle", "name": "B", "i": "arm", "j": "disc", "value": 0})" +
           constraints + R"(], "analyses": [{"type": "assemble"}], "outputs": ["arm.angle", "disc.angle"]})";
  };
  const TextRun alone = run_text(scene("", ""));
  ASSERT_EQ(alone.outcome.exit_code, 0) << alone.outcome.error_text;
  EXPECT_GT(alone.last("arm.angle"), 0.01);
  for (const char* beside : {R"({"type": "weld", "name": "W", "i": ["ground", [9, 7]], "j": ["other", [-9, -7]]})",
                             R"({"type": "revolute", "name": "W", "i": "ground", "j": ["other", [-18, -14]]})"}) {
    const TextRun both = run_text(scene(R"(, "other": {"position": [18, 14]})", std::string(", ") + beside));
    ASSERT_EQ(both.outcome.exit_code, 0) << both.outcome.error_text;
    EXPECT_NEAR(both.last("arm.angle"), alone.last("arm.angle"), 1e-12) << beside;
    EXPECT_NEAR(both.last("disc.angle"), alone.last("disc.angle"), 1e-12) << beside;
  }
}

// A bar on equal cranks has one more equation than it needs in every pose, and two in the flat position, which searches
// approach slowly: they are to end on the branch, where the bar is level and all cranks have one angle.
TEST(AssemblyScene, BarsOnCranksDoNotEndBesideTheFlatPosition) {
  std::mt19937_64 engine(3);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(engine() >> 11), -53);
  };
  for (int k = 0; k < 24; ++k) {
    SCOPED_TRACE(k);
    const int cranks = 3 + k % 4;
    const double angle = draw(0.4, 2.7);
    std::string bodies, joints, sep;
    for (int c = 0; c < cranks; ++c) {
      const double x = draw(-0.3, 0.3), y = draw(-0.3, 0.3), turn = draw(-0.3, 0.3);
      const std::string name = "c" + std::to_string(c), place = std::to_string(c);
      bodies += "\"" + name + R"(": {"mass": 1, "inertia": 0.1, "points": {"r": [1, 0]}, "position": [)" +
                std::to_string(c + x) + ", " + std::to_string(y) + R"(], "angle": )" + std::to_string(angle + turn) +
                "}, ";
      joints += sep + R"({"type": "revolute", "i": ["ground", [)" + place + R"(, 0]], "j": ")" + name +
                R"("}, {"type": "revolute", "i": ")" + name + R"(.r", "j": ["bar", [)" + place + ", 0]]}";
      sep = ", ";
    }
    const double x = std::cos(angle) + draw(-0.3, 0.3), y = std::sin(angle) + draw(-0.3, 0.3), turn = draw(-0.3, 0.3);
    const TextRun run =
        run_text(R"({"catena": 1, "bodies": {)" + bodies + R"("bar": {"mass": 1, "inertia": 1, "position": [)" +
                 std::to_string(x) + ", " + std::to_string(y) + R"(], "angle": )" + std::to_string(turn) +
                 R"(}}, "constraints": [)" + joints + R"(], "analyses": [{"type": "assemble"}, {"type": "check"}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(run.last("bar.angle"), 0, 1e-11);
    for (int c = 1; c < cranks; ++c)
      EXPECT_NEAR(run.last("c" + std::to_string(c) + ".angle"), run.last("c0.angle"), 1e-11);
    EXPECT_EQ(run.analysis(1).report.dof, 1);
  }
}

// The same drawn flat, but for the bar: whatever it is turned by, steps lead to the flat position itself, and halve the
// distance to it. They are to end on it, not a square root of the tolerance beside, where all equations look
// independent.
TEST(AssemblyScene, FlatSketchesOfBarsOnCranksEndInTheFlatPosition) {
  std::mt19937_64 engine(4);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(engine() >> 11), -53);
  };
  for (int k = 0; k < 12; ++k) {
    SCOPED_TRACE(k);
    const double pitch = draw(0.9, 1.6), turn = draw(0.05, 0.3);
    std::string bodies, joints, sep;
    for (int c = 0; c < 3; ++c) {
      const std::string name = "c" + std::to_string(c), place = std::to_string(c * pitch);
      bodies += "\"" + name + R"(": {"points": {"r": [1, 0]}, "position": [)" + place + R"(, 0], "angle": 0}, )";
      joints += sep + R"({"type": "revolute", "i": ["ground", [)" + place + R"(, 0]], "j": ")" + name +
                R"("}, {"type": "revolute", "i": ")" + name + R"(.r", "j": ["bar", [)" + place + ", 0]]}";
      sep = ", ";
    }
    const TextRun run = run_text(R"({"catena": 1, "bodies": {)" + bodies + R"("bar": {"position": [1, 0], "angle": )" +
                                 std::to_string(turn) + R"(}}, "constraints": [)" + joints +
                                 R"(], "analyses": [{"type": "assemble"}, {"type": "check"}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    for (const char* column : {"bar.angle", "c0.angle", "c1.angle", "c2.angle"})
      EXPECT_NEAR(std::remainder(run.last(column), 2 * std::numbers::pi), 0, 1e-9) << column;
    EXPECT_EQ(run.analysis(1).report.dof, 2);
  }
}

}  // namespace
}  // namespace catena::testing
