// Optimisation: known optima by every method, designs that fail, constraints that cannot be met, wrong scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "catena/analysis/design/design_problem.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// (x - 0.3)^2 + 2 (y + 0.2)^2 subject to x + y >= 0.4: at the optimum 2 (x - 0.3) = 4 (y + 0.2).
DesignProblem quadratic() {
  DesignProblem problem{{-1, -1}, {1, 1}, {0.9, 0.9}, 1, 0, {}};
  problem.evaluate = [](std::span<const double> x, bool) {
    DesignEvaluation e;
    e.values.objective = (x[0] - 0.3) * (x[0] - 0.3) + 2 * (x[1] + 0.2) * (x[1] + 0.2);
    e.values.gradient = {2 * (x[0] - 0.3), 4 * (x[1] + 0.2)};
    e.values.unequal = {0.4 - x[0] - x[1]};
    e.values.unequal_gradient = {-1, -1};
    return e;
  };
  return problem;
}

class EveryMethod : public ::testing::TestWithParam<MinimiserMethod> {};

TEST_P(EveryMethod, FindsAKnownOptimum) {
  DesignOptions options;
  options.method = GetParam();
  options.max_evaluations = 20000;
  const DesignOutcome outcome = optimise_design(quadratic(), options);
  ASSERT_EQ(outcome.x.size(), 2u);
  const double tolerance = uses_gradients(GetParam()) ? 1e-6 : searches_everywhere(GetParam()) ? 0.02 : 1e-4;
  EXPECT_NEAR(outcome.x[0], 0.5, tolerance);
  EXPECT_NEAR(outcome.x[1], -0.1, tolerance);
  EXPECT_LE(outcome.violation, 1e-6);
  if (uses_gradients(GetParam())) {
    EXPECT_EQ(outcome.end, DesignEnd::converged);
    EXPECT_LT(outcome.optimality, 1e-5);
    EXPECT_EQ(outcome.active_unequal, std::vector<int>{0});
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         ::testing::Values(MinimiserMethod::slsqp, MinimiserMethod::mma, MinimiserMethod::bobyqa,
                                           MinimiserMethod::cobyla, MinimiserMethod::crs2, MinimiserMethod::isres,
                                           MinimiserMethod::direct));

TEST(Optimise, GoesOnBesideDesignsThatFail) {
  DesignProblem problem{{0}, {3}, {0.2}, 0, 0, {}};
  // Falls towards 2, but nothing beyond 1.5 can be analysed.
  problem.evaluate = [](std::span<const double> x, bool) {
    DesignEvaluation e;
    if (x[0] > 1.5) e.failure = "not_assembled";
    e.values.objective = (x[0] - 1.2) * (x[0] - 1.2);
    e.values.gradient = {2 * (x[0] - 1.2)};
    return e;
  };
  const DesignOutcome outcome = optimise_design(problem, {});
  EXPECT_EQ(outcome.end, DesignEnd::converged);
  EXPECT_NEAR(outcome.x.at(0), 1.2, 1e-6);
}

TEST(Optimise, SaysThatConstraintsCannotBeMet) {
  DesignProblem problem = quadratic();
  problem.evaluate = [](std::span<const double> x, bool) {
    DesignEvaluation e;
    e.values.objective = x[0];
    e.values.gradient = {1, 0};
    e.values.unequal = {3 - x[0] - x[1]};
    e.values.unequal_gradient = {-1, -1};
    return e;
  };
  const DesignOutcome outcome = optimise_design(problem, {});
  EXPECT_NE(outcome.end, DesignEnd::converged);
  EXPECT_NEAR(outcome.x.at(0) + outcome.x.at(1), 2, 1e-6);  // the least infeasible one: both at their upper bounds
}

TEST(Optimise, RefusesProblemsThatAreNone) {
  DesignProblem problem = quadratic();
  problem.start = {2, 0};
  EXPECT_THROW(optimise_design(problem, {}), std::invalid_argument);
  problem = quadratic();
  problem.lower[0] = 1;
  EXPECT_THROW(optimise_design(problem, {}), std::invalid_argument);
}

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

TEST(Optimise, FindsTheCrankOfAStroke) {
  const TextRun run = run_text(slider(R"("variables": {"r": {}}, "minimise": "=(stroke - 0.5)^2")"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(number(run, "variables", "r"), 0.25, 1e-6);
  EXPECT_NEAR(field<double>(run, "objective"), 0, 1e-11);
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
  expect_error(R"("variables": {§"q": {}}, "minimise": "stroke")", "unknown parameter \"q\"");
  expect_error(R"("variables": {"r": {"min": §0.3, "max": 0.2}}, "minimise": "stroke")", "is not below its max");
  expect_error(R"("variables": {"r": {"start": §0.9}}, "minimise": "stroke")", "not within");
  expect_error(R"("variables": {"l": §{}}, "minimise": "stroke")", "needs \"min\" and \"max\"");
  expect_error(R"("variables": {"r": {}}, "minimise": "=2*§strok")", "did you mean \"stroke\"?");
  expect_error(R"("variables": {"r": {}}, "minimise": "stroke", "subject_to": [§"=stroke"])", "a relation");
}

}  // namespace
}  // namespace catena::testing
