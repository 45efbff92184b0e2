// What an event has released stays released in the analyses that start from where it ended.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/event_entries.hpp"
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

// What is inside another analysis may begin anew.
TEST(ReleasedConstraints, HoldInsideWhereThatBeginsFromTheScene) {
  for (const bool anew : {false, true}) {
    const std::string of = std::string(R"("of": {"type": "equilibrium", )") + (anew ? R"("from": "initial", )" : "") +
                           R"("measures": {"y": {"final": "p.y"}}})";
    const TextRun run = run_text(weight(R"({"type": "sweep", "over": {"m": [1, 2]}, )" + of +
                                        R"(}, {"type": "sensitivity", "parameters": ["m"], )" + of + "}"));
    for (std::size_t k = 0; k < 3; ++k) ASSERT_TRUE(run.analysis(k).report.ok()) << run.analysis(k).report.message;
    EXPECT_NEAR(run.last("y", 1), anew ? 0 : -0.2, 1e-12);
    for (std::size_t k = 1; k < 3; ++k) EXPECT_EQ(names_pin(run.analysis(k)), !anew) << k;
  }
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

// A lock that opens and may close again holds from the start. A rod that it lets go level is at its lowest place after
// K sqrt(2 l / 3 g), K = K(sin 45 deg).
TEST(ReleasedConstraints, HoldFromTheStartWhatIsReleasedFirst) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"a": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "a.from"},
                    {"type": "absolute_angle", "name": "lock", "i": "a", "value": 0}],
    "outputs": ["a.angle"], "analyses": [{"type": "dynamics", "until": 1.4, "every": 0.1, "events": [
      {"name": "go", "when": "t", "value": 0.5, "action": "release", "element": "lock"},
      {"name": "back", "when": "a.angle", "value": 1, "action": "engage", "element": "lock"},
      {"name": "low", "when": "=a.angle + pi/2"}]}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_TRUE(run.analysis().report.warnings.empty());
  const std::vector<double> t = run.column("t"), angle = run.column("a.angle");
  for (std::size_t k = 0; k < t.size() && t[k] <= 0.5; ++k) EXPECT_NEAR(angle[k], 0, 1e-12) << t[k];
  const std::vector<EventEntry> events = events_of(run);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_NEAR(events[1].t, 0.5 + 1.8540746773013719 * std::sqrt(2 / (3 * 9.81)), 1e-7);

  // x = t, between 0.5 s and 1.5 s x = t + (t - 0.5) (t - 1.5).
  const TextRun driven = run_text(R"({"catena": 1, "bodies": {"a": {"particle": true}},
    "constraints": [{"type": "absolute_y", "i": "a", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "even", "i": "a", "value": {"polynomial": [0, 1]}},
                {"type": "absolute_x", "name": "bent", "i": "a", "value": {"polynomial": [0.75, -1, 1]}}],
    "outputs": ["a.x"], "analyses": [{"type": "kinematics", "until": 2, "every": 0.25, "events": [
      {"when": "t", "value": 0.5, "action": "release", "element": "even"},
      {"when": "t", "value": 0.5, "action": "engage", "element": "bent"},
      {"when": "t", "value": 1.5, "action": "release", "element": "bent"},
      {"when": "t", "value": 1.5, "action": "engage", "element": "even"}]}]})");
  ASSERT_TRUE(driven.analysis().report.ok()) << driven.analysis().report.message;
  const std::vector<double> instants = driven.column("t"), x = driven.column("a.x");
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double s = instants[k], bent = s > 0.5 && s < 1.5 ? (s - 0.5) * (s - 1.5) : 0;
    EXPECT_NEAR(x[k], s + bent, 1e-12) << s;
  }
}

}  // namespace
}  // namespace catena::testing
