// What an event has released stays released in the analyses that start from where it ended.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A weight of 10 N on a spring of 100 N/m, held at y = 0 by a pin that breaks at t = 0.1.
std::string weight(const std::string& analyses, const std::string& driver = "") {
  return R"({"catena": 1, "gravity": [0, -10], "parameters": {"m": 1}, "bodies": {"p": {"particle": true, "mass": "m"}},
    "constraints": [{"type": "absolute_x", "i": "p", "value": 0}, {"type": "absolute_y", "name": "pin", "i": "p", "value": 0}],
    "forces": [{"type": "spring_damper", "i": "ground", "j": "p", "k": 100, "length": 0}], )" +
         driver + R"("outputs": ["p.y"], "analyses": [{"type": "dynamics", "until": 0.2, "every": 0.1,
    "events": [{"name": "breaks", "when": "t", "value": 0.1, "action": "release", "element": "pin"}]}, )" +
         analyses + "]}";
}

bool names_pin(const AnalysisResult& result) {
  for (const std::string& warning : result.report.warnings) {
    if (warning.find("\"pin\"") != std::string::npos) return true;
  }
  return false;
}

TEST(ReleasedConstraints, DoNotHoldInTheNextAnalysis) {
  const TextRun run = run_text(weight(R"({"type": "equilibrium"}, {"type": "modes"}, {"type": "assemble"},
    {"type": "buckling", "parameter": "m"}, {"type": "path", "parameter": "m", "to": 2}, {"type": "check"},
    {"type": "dynamics", "until": 0.4, "set": {"m": 1}}, {"type": "equilibrium", "from": "initial"})"));
  for (std::size_t k = 0; k < 9; ++k) ASSERT_TRUE(run.analysis(k).report.ok()) << k << run.analysis(k).report.message;
  EXPECT_NEAR(run.last("p.y", 1), -0.1, 1e-12);
  EXPECT_EQ(run.column("omega2", 2).size(), 1U);
  EXPECT_NEAR(run.last("omega2", 2), 100, 1e-9);
  EXPECT_NEAR(run.last("p.y", 3), -0.1, 1e-12);
  EXPECT_NEAR(run.last("p.y", 5), -0.2, 1e-12);
  EXPECT_EQ(run.analysis(6).report.dof, 1);
  EXPECT_NEAR(run.last("p.y", 7), -0.1 - 0.1 * std::cos(2), 1e-7);  // from rest at the end of the path
  EXPECT_NEAR(run.last("p.y", 8), 0, 1e-15);
  for (std::size_t k = 1; k < 8; ++k) EXPECT_TRUE(names_pin(run.analysis(k))) << k;
  EXPECT_FALSE(names_pin(run.analysis(0)));
  EXPECT_FALSE(names_pin(run.analysis(8)));
}

TEST(ReleasedConstraints, HoldAgainWhereAnEventEngagesThem) {
  // It falls, is carried back to y = 0 by the spring that has become stronger, and caught there.
  const TextRun run =
      run_text(R"({"catena": 1, "parameters": {"f": -10}, "bodies": {"p": {"particle": true, "mass": 1}},
    "constraints": [{"type": "absolute_x", "i": "p", "value": 0}, {"type": "absolute_y", "name": "pin", "i": "p", "value": 0}],
    "forces": [{"type": "point_force", "i": "p", "force": [0, "f"]}], "outputs": ["p.y"], "analyses": [
    {"type": "dynamics", "until": 0.2, "events": [{"name": "breaks", "when": "t", "value": 0.1, "action": "release", "element": "pin"}]},
    {"type": "dynamics", "until": 2, "set": {"f": 50}, "events": [{"name": "caught", "when": "p.y", "direction": "up",
      "action": "engage", "element": "pin"}]},
    {"type": "dynamics", "until": 3, "set": {"f": 50}}]})");
  for (std::size_t k = 0; k < 3; ++k) ASSERT_TRUE(run.analysis(k).report.ok()) << k << run.analysis(k).report.message;
  EXPECT_NEAR(run.last("p.y", 0), -0.05, 1e-9);
  EXPECT_NEAR(run.last("p.y", 1), 0, 1e-9);
  EXPECT_NEAR(run.last("p.y", 2), 0, 1e-9);
  EXPECT_FALSE(names_pin(run.analysis(2)));
}

TEST(ReleasedConstraints, OfADrivenMotionStayReleased) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"p": {"particle": true, "mass": 1}},
    "constraints": [{"type": "absolute_x", "i": "p", "value": 0}],
    "drivers": [{"type": "absolute_y", "name": "pin", "i": "p", "value": {"polynomial": [0, 1]}}],
    "gravity": [0, -10], "outputs": ["p.y"], "analyses": [
    {"type": "kinematics", "until": 1, "every": 0.5, "events": [
      {"name": "breaks", "when": "t", "value": 0.5, "action": "release", "element": "pin"},
      {"name": "ends", "when": "t", "value": 0.5, "action": "stop"}]},
    {"type": "dynamics", "until": 1.5}]})");
  ASSERT_EQ(run.outcome.analyses.size(), 2U);
  ASSERT_TRUE(run.analysis(1).report.ok()) << run.analysis(1).report.message;
  EXPECT_NEAR(run.last("p.y", 1), 0.5 + 1 - 5, 1e-6);
}

}  // namespace
}  // namespace catena::testing
