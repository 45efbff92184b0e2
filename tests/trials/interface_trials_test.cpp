// Faults that users found in what scenes may say and in what results hold: each test failed before it was mended.
#include <gtest/gtest.h>

#include <cmath>

#include "trials/trial.hpp"

namespace catena {
namespace {

using testing::run_text;
using testing::TextRun;

double gradient(const TextRun& run, const std::string& measure, std::size_t parameter, std::size_t analysis = 0) {
  for (const MeasureResult& result : run.analysis(analysis).measures) {
    if (result.name == measure) return result.gradient.at(parameter);
  }
  ADD_FAILURE() << "no measure " << measure;
  return std::nan("");
}

// Two drivers that ask the same of one crank: without them it has one freedom, not two.
TEST(InterfaceTrials, DriversThatAgreeTakeOneFreedom) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"c": {}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "c"}],
    "drivers": [{"type": "absolute_angle", "name": "one", "i": "c", "value": {"polynomial": [0, 1]}},
                {"type": "absolute_angle", "name": "two", "i": "c", "value": {"polynomial": [0, 1]}}],
    "analyses": [{"type": "kinematics", "until": 1, "every": 0.5}, {"type": "check"}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.analysis(0).report.mobility, 1);
  EXPECT_EQ(run.analysis(1).report.mobility, 1);
  EXPECT_EQ(run.analysis(0).report.redundant, run.analysis(1).report.redundant);
}

// x = b c, b = a^2: derivatives by a go through b, also where those by b are asked for beside them.
TEST(InterfaceTrials, DerivativesGoThroughParametersThatAreListedToo) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"a": 2, "b": "=a^2", "c": 3},
    "bodies": {"p": {"particle": true, "position": ["=b*c", "a"]}},
    "analyses": [{"type": "sensitivity", "parameters": ["a", "b", "c"], "verify": true, "outputs": ["p.x"],
      "of": {"type": "assemble", "measures": {"x": {"final": "p.x"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("d(p.x)/d(a)"), 12, 1e-12);
  EXPECT_NEAR(run.last("d(p.x)/d(b)"), 3, 1e-12);
  EXPECT_NEAR(run.last("d(p.x)/d(c)"), 4, 1e-12);
  EXPECT_NEAR(gradient(run, "x", 0), 12, 1e-12);
  EXPECT_LE(testing::field<double>(run, "deviation"), 1e-7);
}

// Measures of an assembled place; what an optimisation found is kept by an analysis that starts from the beginning.
TEST(InterfaceTrials, AnOptimumIsKept) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"a": {"value": 0.5, "min": 0.1, "max": 2}},
    "bodies": {"p": {"particle": true, "position": ["a", 0]}}, "outputs": ["p.x"],
    "analyses": [{"type": "optimise", "of": {"type": "assemble", "measures": {"x": {"final": "p.x"}}},
      "variables": {"a": {}}, "minimise": "=(x-0.7)^2"},
      {"type": "assemble", "from": "initial"}, {"type": "assemble", "from": "initial", "set": {"a": 0.3}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("p.x", 1), 0.7, 1e-7);
  EXPECT_EQ(run.last("p.x", 2), 0.3);
}

// Columns that the command line names are those of the analysis inside.
TEST(InterfaceTrials, OutputsOfASensitivityFromOutside) {
  RunOptions options;
  options.outputs = {"p.y"};
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"a": 2},
    "bodies": {"p": {"particle": true, "position": ["a", "=3*a"]}}, "outputs": ["p.x"],
    "analyses": [{"type": "sensitivity", "parameters": ["a"], "of": {"type": "assemble"}}]})",
                               options);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.last("p.y"), 6);
  EXPECT_EQ(run.last("d(p.y)/d(a)"), 3);
  EXPECT_TRUE(run.column("p.x").empty());
}

std::string struck(const std::string& event) {
  return R"({"catena": 1, "bodies": {"b": {"mass": 2, "particle": true}}, "outputs": ["b.x"],
    "analyses": [{"type": "dynamics", "until": 1, "every": 0.5, "events": [{"name": "k", "when": "t", "value": 0.5, )" +
         event + "}]}]}";
}

TEST(InterfaceTrials, AnImpulseMayBeCalledAnAction) {
  const TextRun run = run_text(struck(R"("action": "impulse", "impulse": {"i": "b", "value": [4, 0]})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("b.x"), 1, 1e-12);
  EXPECT_NE(run_text(struck(R"("action": "impulse")")).outcome.error_text.find("needs \"impulse\""), std::string::npos);
}

// A misspelt action is one error: nothing more is said of the event's element.
TEST(InterfaceTrials, AMisspeltActionIsOneError) {
  const std::string text = run_text(struck(R"("action": "relese", "element": "b")")).outcome.error_text;
  EXPECT_NE(text.find("did you mean \"release\""), std::string::npos) << text;
  EXPECT_EQ(text.find("has no meaning"), std::string::npos) << text;
}

}  // namespace
}  // namespace catena
