// Optimisation of scenes: what is found, saved and refused, relations between parameters, adjoints that lead to
// nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catena/scene/designing/design_runs.hpp"
#include "catena/scene/running/scene_setup.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A slider on a crank r with a rod l: the stroke is 2 r as long as l > r.
std::string slider(const std::string& optimise) {
  return R"({"catena": 1, "parameters": {
    "r": {"value": 0.2, "min": 0.05, "max": 0.4},  // to be found
    "l": 0.5},
  "bodies": {"crank": {"points": {"end": ["r", 0]}}, "rod": {"points": {"end": ["l", 0]}, "position": ["r", 0]},
             "slider": {"position": ["=r+l", 0]}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank"}, {"type": "revolute", "i": "crank.end", "j": "rod"},
    {"type": "revolute", "i": "rod.end", "j": "slider"},
    {"type": "translational", "i": "ground", "j": "slider", "axis_i": [1, 0]}],
  "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": [0, 1]}}],
  "outputs": ["slider.x"],
  "analyses": [{"type": "optimise", "of": {"type": "kinematics", "until": 6.3, "every": 0.3,
     "measures": {"stroke": {"range": "slider.x"}}}, )" +
         optimise + R"(}, {"type": "kinematics", "until": 1, "every": 0.5, "from": "previous"}]})";
}

double number(const TextRun& run, const std::string& name, const std::string& variable) {
  for (const auto& [key, value] : field<FieldRecord>(run, name)) {
    if (key == variable) return std::get<double>(value);
  }
  ADD_FAILURE() << "no " << variable;
  return std::nan("");
}

// A block with the speed 2 slides for 0.4 s: mu m g (v t - mu g t^2/2) is lost. That has no derivative yet.
TEST(Optimise, GoesOnByValuesWhereDerivativesAreMissing) {
  for (const char* more : {"", R"(, "subject_to": ["=lost >= 2"])", R"(, "solver": "slsqp")"}) {
    SCOPED_TRACE(more);
    const TextRun run = run_text(std::string(R"({"catena": 1, "gravity": [0, -10],
      "parameters": {"mu": {"value": 0.2, "min": 0.05, "max": 0.5}},
      "bodies": {"block": {"mass": 2, "particle": true, "velocity": [2, 0]}},
      "forces": [{"type": "contact", "i": "ground", "j": "block", "curve": {"line": {"point": [0, 0], "axis": [1, 0]}},
                  "mu": "mu"}],
      "analyses": [{"type": "optimise", "of": {"type": "dynamics", "until": 0.4, "measures":
        {"lost": {"final": "energy.dissipated"}}}, "variables": {"mu": {}}, "minimise": "=(lost - 2.5)^2")") +
                                 more + "}]}");
    if (std::string(more).find("solver") != std::string::npos) {
      EXPECT_EQ(run.analysis().report.status, Status::refused);
      continue;
    }
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    // 20 mu (0.8 - 0.8 mu) = 2.5
    EXPECT_NEAR(number(run, "variables", "mu"), (1 - std::sqrt(1 - 4 * 2.5 / 16)) / 2, 1e-4);
    EXPECT_EQ(field<std::string>(run, "solver"), *more ? "cobyla" : "bobyqa");
    EXPECT_FALSE(run.analysis().report.warnings.empty());
  }
}

TEST(Optimise, FindsTheCrankOfAStroke) {
  const TextRun run = run_text(slider(R"("variables": {"r": {}}, "minimise": "=(stroke - 0.5)^2")"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(number(run, "variables", "r"), 0.25, 1e-6);
  EXPECT_NEAR(field<double>(run, "objective"), 0, 1e-11);
}

// Work has no derivative: searching as if it were zero would end at the start.
TEST(Optimise, MissingDerivativesAreRefusedByNameUnlessTheyAreNotNeeded) {
  const auto text = [](const std::string& solver) {
    return R"({"catena": 1, "gravity": [0, -10], "parameters": {"r": {"value": 0.2, "min": 0.1, "max": 0.5}},
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": ["r", 0]}, "mass": 2}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "rod.from"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "rod", "value": {"polynomial": [0, 1]}}],
  "outputs": ["rod.angle"],
  "analyses": [{"type": "optimise", "solver": ")" +
           solver + R"(", "variables": {"r": {}}, "minimise": "=(lift - 3)^2",
    "of": {"type": "inverse_dynamics", "until": 2, "every": 1, "measures": {"lift": {"max": "drive.work"}}}}]})";
  };
  const TextRun refused = run_text(text("slsqp"));
  EXPECT_EQ(refused.analysis().report.status, Status::refused);
  for (const char* part : {"\"lift\"", "\"r\"", "bobyqa"})
    EXPECT_NE(refused.analysis().report.message.find(part), std::string::npos) << refused.analysis().report.message;
  const TextRun found = run_text(text("bobyqa"));
  ASSERT_EQ(found.outcome.exit_code, 0) << found.outcome.error_text << found.analysis().report.message;
  EXPECT_NEAR(number(found, "variables", "r"), 0.3, 1e-5);  // m g r/2 at its highest, with 10 r J
  EXPECT_TRUE(std::isnan(field<double>(found, "optimality")));
}

TEST(Optimise, KeepsToRelations) {
  const TextRun run = run_text(slider(
      R"("variables": {"r": {}, "l": {"min": 0.3, "max": 1}}, "minimise": "=l", "subject_to": ["=stroke >= 0.6", "=r <= 0.8*l"])"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(number(run, "variables", "r"), 0.3, 1e-6);
  EXPECT_NEAR(number(run, "variables", "l"), 0.375, 1e-6);
  EXPECT_EQ(field<std::vector<std::string>>(run, "active").size(), 2u);
}

TEST(Optimise, SavesTheSceneWithCommentsAndLayout) {
  TemporaryFolder folder;
  const std::string scene = folder / "scene.json", best = folder / "best.json";
  const std::string text = slider(R"("variables": {"r": {}}, "minimise": "=(stroke - 0.5)^2")");
  std::ofstream(scene, std::ios::binary) << text;
  RunOptions options;
  options.only = "optimise";
  options.save = best;
  TextRun run;
  run.outcome = run_scene(scene, options, run.sink);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.outcome.analyses.size(), 1u);
  std::ifstream file(best, std::ios::binary);
  const std::string saved((std::istreambuf_iterator<char>(file)), {});
  const std::size_t from = saved.find("\"value\": ") + 9;
  EXPECT_NEAR(std::stod(saved.substr(from)), 0.25, 1e-6);
  EXPECT_EQ(saved.substr(0, from), text.substr(0, from));
  EXPECT_EQ(saved.substr(saved.find(',', from)), text.substr(text.find(',', from)));
}

TEST(Optimise, WrongGoalsAreReportedWhereTheyStand) {
  const auto expect_error = [](const std::string& goal, const std::string& part) {
    const MarkedText mark = take_mark(slider(goal));
    const TextRun run = run_text(mark.text);
    EXPECT_EQ(run.outcome.exit_code, 3);
    ASSERT_FALSE(run.outcome.errors.empty()) << goal;
    EXPECT_EQ(run.outcome.errors.front().line, mark.line) << run.outcome.errors.front().message;
    EXPECT_EQ(run.outcome.errors.front().column, mark.column) << run.outcome.errors.front().message;
    EXPECT_NE(run.outcome.errors.front().message.find(part), std::string::npos) << run.outcome.errors.front().message;
  };
  expect_error(R"("variables": {"r": {}}, "minimise": §"=3")", "the same for every design");
  expect_error(R"("variables": {"r": {}}, "maximise": §"=2*l")", "the same for every design");
  expect_error(R"("variables": {"r": {}}, "minimise": "stroke", "subject_to": ["=r >= 0.1", §"=1 >= l"])",
               "the same for every design");
  expect_error(R"("variables": {"r": §{"min": 0.3, "max": 0.4}}, "minimise": "stroke")", "starts at 0.2");
  expect_error(R"("variables": {§"q": {}}, "minimise": "stroke")", "unknown parameter \"q\"");
  expect_error(R"("variables": {"r": {"min": §0.3, "max": 0.2}}, "minimise": "stroke")", "is not below its max");
  expect_error(R"("variables": {"r": {"start": §0.9}}, "minimise": "stroke")", "not within");
  expect_error(R"("variables": {"l": §{}}, "minimise": "stroke")", "needs \"min\" and \"max\"");
  expect_error(R"("variables": {"r": {}}, "minimise": "=2*§strok")", "did you mean \"stroke\"?");
  expect_error(R"("variables": {"r": {}}, "minimise": "stroke", "subject_to": [§"=stroke"])", "a relation");
}

TEST(Optimise, MeasuresOfWhatAnotherAnalysisReportsAreErrorsWhereTheyStand) {
  for (const auto& [type, field, other] : {std::array{"\"kinematics\", \"until\": 1", "energy", "equilibrium"},
                                           {"\"equilibrium\"", "omega[1]", "modes"},
                                           {"\"modes\"", "loads[1]", "buckling"},
                                           {"\"buckling\", \"parameter\": \"p\"", "omega2[1]", "modes"}}) {
    const MarkedText mark = take_mark(fmt::format(R"({{"catena": 1, "parameters": {{"p": 1}},
      "bodies": {{"b": {{"mass": 1, "inertia": 1}}}}, "constraints": [{{"type": "revolute", "i": "ground", "j": "b"}}],
      "analyses": [{{"type": {}, "measures": {{"m": {{"field": §"{}"}}}}}}]}})",
                                                  type, field));
    const TextRun run = run_text(mark.text);
    ASSERT_EQ(run.outcome.errors.size(), 1u) << field;
    EXPECT_EQ(run.outcome.errors.front().line, mark.line);
    EXPECT_EQ(run.outcome.errors.front().column, mark.column);
    EXPECT_NE(run.outcome.errors.front().message.find(other), std::string::npos) << run.outcome.errors.front().message;
  }
}

// A bob at rest on one rod, or on two of one length, which adjoints do not treat: of a search's first design they are
// asked and the analysis is run twice, of those after it once.
TEST(Optimise, AsksAdjointsThatLeadToNothingOnceInASearch) {
  const std::string second =
      R"(, {"type": "absolute_distance", "name": "second", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l"})";
  for (const bool redundant : {false, true}) {
    TemporaryFolder folder;
    const std::string path = folder / "scene.json";
    std::ofstream(path, std::ios::binary) << fmt::format(
        R"({{"catena": 1, "gravity": [0, -9.81], "parameters": {{"l": 2, "a": 0, "b": 0, "c": 0, "d": 0}},
        "bodies": {{"bob": {{"mass": "=1+a+b+c+d", "inertia": 1, "position": [0.1, -1.9]}}}},
        "constraints": [
          {{"type": "absolute_angle", "name": "level", "i": "bob"}},
          {{"type": "absolute_distance", "name": "first", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l"}}{}],
        "analyses": [{{"type": "optimise", "of": {{"type": "equilibrium", "measures": {{"y": {{"final": "bob.y"}}}}}},
          "variables": {{"l": {{"min": 1, "max": 3}}, {}}}, "minimise": "y"}}]}})",
        redundant ? second : "",
        R"("a": {"max": 1, "min": -0.1}, "b": {"max": 1, "min": -0.1}, "c": {"max": 1, "min": -0.1},
           "d": {"max": 1, "min": -0.1})");
    const RunOptions options;
    SceneOutcome outcome;
    SceneSetup setup(options, outcome);
    ASSERT_TRUE(setup.read(path)) << outcome.error_text;
    SystemState state;
    ResultStorage rows;
    const AnalysisContext context{.task = setup.tasks().front(),
                                  .model = setup.model(),
                                  .state = state,
                                  .rows = rows,
                                  .progress = {},
                                  .models = &setup.models()};
    DesignRuns runs(context);
    AdjointRecord record;
    for (const double length : {2.0, 1.5, 2.5}) {
      const DesignEvaluation found = runs.evaluate(std::vector<double>{length, 0.1, 0.2, 0.3, 0.4}, true, record);
      ASSERT_TRUE(found.failure.empty()) << found.failure;
      EXPECT_NEAR(found.values.objective, -length, 1e-9);
      ASSERT_EQ(found.values.gradient.size(), 5u);
      EXPECT_NEAR(found.values.gradient[0], -1, 1e-9);
      EXPECT_NEAR(found.values.gradient[4], 0, 1e-9);
    }
    EXPECT_EQ(record, AdjointRecord{redundant ? -1 : 3});
  }
}

}  // namespace
}  // namespace catena::testing
