// Optimisation: known optima by every method, designs that fail, constraints that cannot be met, wrong problems.
// Of scenes: optimise_scenes_test.cpp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "catena/analysis/design/design_problem.hpp"

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
  // What crs2, isres and direct find everywhere within the bounds ends a search from there.
  const double tolerance = uses_gradients(GetParam()) ? 1e-6 : 1e-4;
  EXPECT_NEAR(outcome.x[0], 0.5, tolerance);
  EXPECT_NEAR(outcome.x[1], -0.1, tolerance);
  EXPECT_LE(outcome.violation, 1e-6);
  if (uses_gradients(GetParam())) {
    EXPECT_EQ(outcome.end, DesignEnd::converged);
    EXPECT_LT(outcome.optimality.value_or(1), 1e-5);
    EXPECT_EQ(outcome.active_unequal, std::vector<int>{0});
  }
}

/// f with its gradient by differences of fourth order, good to 1e-11.
DesignProblem problem_of(std::vector<double> lower, std::vector<double> upper, std::vector<double> start,
                         std::function<double(std::span<const double>)> f) {
  DesignProblem problem{std::move(lower), std::move(upper), std::move(start), 0, 0, {}};
  problem.evaluate = [f](std::span<const double> x, bool) {
    DesignEvaluation e;
    e.values.objective = f(x);
    std::vector<double> y(x.begin(), x.end());
    for (std::size_t v = 0; v < x.size(); ++v) {
      const double h = 1e-3;
      const auto at = [&](double step) {
        y[v] = x[v] + step;
        return f(y);
      };
      const double a = at(-2 * h), b = at(-h), c = at(h), d = at(2 * h);
      y[v] = x[v];
      e.values.gradient.push_back((a - 8 * b + 8 * c - d) / (12 * h));
    }
    return e;
  };
  return problem;
}

// What is called an optimum is stationary, or says that it is not, whatever the method and its tolerance.
TEST_P(EveryMethod, CallsNothingAnOptimumThatIsNotStationary) {
  const auto valley = [](std::span<const double> x) {
    return std::pow(1 - x[0], 2) + 100 * std::pow(x[1] - x[0] * x[0], 2);
  };
  const auto bowl = [](std::span<const double> x) {
    return 5 + std::pow(x[0] - 0.2, 2) + 3 * std::pow(x[1] - 0.4, 2) + x[0] * x[1];
  };
  for (const double tolerance : {1e-8, 1e-4}) {
    for (const auto& f : {std::function<double(std::span<const double>)>(valley), {bowl}}) {
      for (const double start : {-1.2, 0.1, 1.9}) {
        SCOPED_TRACE(fmt::format("tolerance {}, start {}", tolerance, start));
        DesignOptions options;
        options.method = GetParam();
        options.tolerance = tolerance;
        options.max_evaluations = 3000;
        const DesignOutcome outcome = optimise_design(problem_of({-2, -2}, {2, 2}, {start, 1}, f), options);
        ASSERT_TRUE(outcome.optimality.has_value());
        if (outcome.end != DesignEnd::converged) {
          EXPECT_FALSE(uses_gradients(GetParam()));
          continue;
        }
        EXPECT_FALSE(outcome.at_kink);
        EXPECT_LT(*outcome.optimality, tolerance == 1e-8 ? 2e-4 : 2e-2);
      }
    }
  }
}

// |x - 0.3| + y^2: its slope does not vanish at the optimum, and this is told.
TEST_P(EveryMethod, TellsAKink) {
  DesignProblem problem{{-1, -1}, {1, 1}, {0.8, 0.7}, 0, 0, {}};
  problem.evaluate = [](std::span<const double> x, bool) {
    DesignEvaluation e;
    e.values.objective = std::abs(x[0] - 0.3) + x[1] * x[1];
    e.values.gradient = {x[0] < 0.3 ? -1.0 : 1.0, 2 * x[1]};
    return e;
  };
  DesignOptions options;
  options.method = GetParam();
  options.max_evaluations = 3000;
  const DesignOutcome outcome = optimise_design(problem, options);
  ASSERT_TRUE(outcome.optimality.has_value());
  if (outcome.end == DesignEnd::converged) {
    EXPECT_TRUE(outcome.at_kink);
    EXPECT_NEAR(outcome.x[0], 0.3, 1e-3);
  }
}

// No more designs than allowed, those that judge the best one among them; a search everywhere ends at an optimum all
// the same: of sin(5 x) + sin(5 y) + (x^2 + y^2) / 4 with nine minima that at x = y, where 5 cos(5 x) + x / 2 = 0.
TEST_P(EveryMethod, TakesNoMoreDesignsThanAllowed) {
  const auto hills = [](std::span<const double> x) {
    return std::sin(5 * x[0]) + std::sin(5 * x[1]) + (x[0] * x[0] + x[1] * x[1]) / 4;
  };
  double least = -0.3;
  for (int k = 0; k < 20; ++k) least -= (5 * std::cos(5 * least) + least / 2) / (0.5 - 25 * std::sin(5 * least));
  for (const int most : {40, 300, 4000}) {
    SCOPED_TRACE(most);
    DesignOptions options;
    options.method = GetParam();
    options.max_evaluations = most;
    const DesignOutcome outcome = optimise_design(problem_of({-2, -2}, {2, 2}, {1.3, 1.1}, hills), options);
    EXPECT_LE(outcome.evaluations, most);
    if (!searches_everywhere(GetParam()) || most < 4000) continue;
    EXPECT_EQ(outcome.end, DesignEnd::converged);
    for (const double x : outcome.x) EXPECT_NEAR(x, least, 1e-5);
  }
}

// A start at the optimum is one: its gradient is rounding, relative to what the search has seen.
TEST_P(EveryMethod, KnowsAnOptimumAtItsStart) {
  DesignOptions options;
  options.method = GetParam();
  options.max_evaluations = 2000;
  const DesignOutcome outcome = optimise_design(
      problem_of({-2}, {2}, {0.7}, [](std::span<const double> x) { return std::pow(x[0] - 0.7, 2); }), options);
  ASSERT_TRUE(outcome.optimality.has_value());
  EXPECT_LT(*outcome.optimality, 1e-4);
  EXPECT_FALSE(outcome.at_kink);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         ::testing::Values(MinimiserMethod::slsqp, MinimiserMethod::mma, MinimiserMethod::ipopt,
                                           MinimiserMethod::bobyqa, MinimiserMethod::cobyla, MinimiserMethod::crs2,
                                           MinimiserMethod::isres, MinimiserMethod::direct));

TEST(Optimise, GoesOnBesideDesignsThatFail) {
  // Nothing beyond 1.5 can be analysed, and the slope at the start points far beyond it: f = -x + x^4 / (4 * 1.4^3),
  // least at 1.4.
  DesignProblem problem{{0}, {10}, {0.2}, 0, 0, {}};
  problem.evaluate = [](std::span<const double> x, bool) {
    DesignEvaluation e;
    if (x[0] > 1.5) e.failure = "not_assembled";
    e.values.objective = -x[0] + std::pow(x[0], 4) / (4 * std::pow(1.4, 3));
    e.values.gradient = {-1 + std::pow(x[0] / 1.4, 3)};
    return e;
  };
  const DesignOutcome outcome = optimise_design(problem, {});
  EXPECT_EQ(outcome.end, DesignEnd::converged);
  EXPECT_NEAR(outcome.x.at(0), 1.4, 1e-5);
  ASSERT_TRUE(outcome.failed.contains("not_assembled"));
  EXPECT_GT(outcome.failed.at("not_assembled"), 0);
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
  EXPECT_EQ(outcome.end, DesignEnd::infeasible);
  EXPECT_NEAR(outcome.x.at(0) + outcome.x.at(1), 2, 1e-6);  // the least infeasible one: both at their upper bounds
}

// x >= 0.4 and x = 0.2: halfway, since both are of one size, wherever the search began.
TEST(Optimise, GivesTheDesignThatMissesConstraintsLeast) {
  for (const MinimiserMethod method :
       {MinimiserMethod::slsqp, MinimiserMethod::mma, MinimiserMethod::ipopt, MinimiserMethod::cobyla}) {
    for (const double start : {-0.9, 0.2, 0.3, 0.8}) {
      SCOPED_TRACE(fmt::format("method {}, start {}", static_cast<int>(method), start));
      DesignProblem problem{{-1, -1}, {1, 1}, {start, 0.5}, 1, 1, {}};
      problem.evaluate = [](std::span<const double> x, bool) {
        DesignEvaluation e;
        e.values.objective = x[1] * x[1] + x[0];
        e.values.gradient = {1, 2 * x[1]};
        e.values.unequal = {0.4 - x[0]};
        e.values.unequal_gradient = {-1, 0};
        e.values.equal = {x[0] - 0.2};
        e.values.equal_gradient = {1, 0};
        return e;
      };
      DesignOptions options;
      options.method = method;
      const DesignOutcome outcome = optimise_design(problem, options);
      EXPECT_EQ(outcome.end, DesignEnd::infeasible);
      EXPECT_NEAR(outcome.x.at(0), 0.3, method == MinimiserMethod::cobyla ? 1e-3 : 1e-6);  // both sizes are 2
    }
  }
}

TEST(Optimise, DesignsWithoutDerivativesOrNumbersAreFailedOnes) {
  DesignProblem problem{{0}, {3}, {0.5}, 0, 0, {}};
  const auto evaluate = [](double derivative_beyond, double value_beyond) {
    return [=](std::span<const double> x, bool) {
      DesignEvaluation e;
      const bool beyond = x[0] > 1.3;
      e.values.objective = beyond ? value_beyond : (x[0] - 1.2) * (x[0] - 1.2);
      e.values.gradient = {beyond ? derivative_beyond : 10 * (x[0] - 1.2)};  // too steep: it jumps over the border
      return e;
    };
  };
  const double nan = std::nan("");
  problem.evaluate = evaluate(nan, 0);
  EXPECT_TRUE(optimise_design(problem, {}).failed.contains("no_derivative"));
  problem.evaluate = evaluate(0, nan);
  EXPECT_TRUE(optimise_design(problem, {}).failed.contains("not_finite"));
}

TEST(Optimise, OptimalityIsUnknownWithoutGradients) {
  DesignProblem problem{{0}, {3}, {0.5}, 0, 0, {}};
  problem.evaluate = [](std::span<const double> x, bool gradients) {
    DesignEvaluation e;
    e.values.objective = (x[0] - 1.2) * (x[0] - 1.2);
    if (gradients) e.failure = "refused";
    return e;
  };
  DesignOptions options;
  options.method = MinimiserMethod::bobyqa;
  const DesignOutcome outcome = optimise_design(problem, options);
  EXPECT_NEAR(outcome.x.at(0), 1.2, 1e-6);
  EXPECT_FALSE(outcome.optimality);
  // The method's own criterion does not hold after three designs, and nothing else says that this is an optimum.
  options.max_evaluations = 3;
  EXPECT_EQ(optimise_design(problem, options).end, DesignEnd::slow);
}

TEST(Optimise, TheEndIsThatOfTheBestStart) {
  // The given start is a minimum of value 1; all others lead into Rosenbrock's valley, whose end, value 0, is far.
  DesignProblem problem{{-2, -2}, {2, 2}, {-1.9, -1.9}, 0, 0, {}};
  problem.evaluate = [](std::span<const double> x, bool) {
    DesignEvaluation e;
    const double dx = x[0] + 1.9, dy = x[1] + 1.9, bend = x[1] - x[0] * x[0];
    const bool near = dx * dx + dy * dy < 0.01;
    e.values.objective = near ? 1 + dx * dx + dy * dy : -1e4 + 100 * bend * bend + (1 - x[0]) * (1 - x[0]);
    e.values.gradient = {near ? 2 * dx : -400 * x[0] * bend - 2 * (1 - x[0]), near ? 2 * dy : 200 * bend};
    return e;
  };
  DesignOptions options;
  EXPECT_EQ(optimise_design(problem, options).end, DesignEnd::converged);
  options.starts = 2;
  options.max_evaluations = 12;
  const DesignOutcome outcome = optimise_design(problem, options);
  ASSERT_LT(outcome.values.objective, 0);
  ASSERT_GT(outcome.optimality.value_or(1), 1e-5);
  EXPECT_EQ(outcome.end, DesignEnd::slow);
}

// f = sum of (x^2 - 1)^2 + x / 4 in each of three variables: eight minima, the least at x = -1.0303 each.
DesignProblem eight_minima() {
  DesignProblem problem{{-2, -2, -2}, {2, 2, 2}, {1.9, 1.8, 1.7}, 0, 0, {}};
  problem.evaluate = [](std::span<const double> x, bool) {
    DesignEvaluation e;
    if (x[0] > 1.2 && x[1] < -1.2) e.failure = "not_assembled";
    for (const double v : x) {
      e.values.objective += (v * v - 1) * (v * v - 1) + v / 4;
      e.values.gradient.push_back(4 * v * (v * v - 1) + 0.25);
    }
    return e;
  };
  return problem;
}

TEST(Optimise, ManyStartsGiveTheSameWhateverTheNumberOfThreads) {
  for (const MinimiserMethod method : {MinimiserMethod::slsqp, MinimiserMethod::mma, MinimiserMethod::bobyqa}) {
    for (const int most : {10000, 150, 40}) {
      std::vector<DesignOutcome> outcomes;
      std::vector<std::vector<std::vector<double>>> rows;
      for (const int threads : {1, 2, 5}) {
        DesignOptions options;
        options.method = method;
        options.starts = 12;
        options.threads = threads;
        options.max_evaluations = most;
        rows.emplace_back();
        options.improved = [&](std::span<const double> x, const DesignValues&) {
          rows.back().emplace_back(x.begin(), x.end());
        };
        outcomes.push_back(optimise_design(eight_minima(), options));
      }
      for (std::size_t k = 1; k < outcomes.size(); ++k) {
        EXPECT_EQ(outcomes[k].x, outcomes[0].x);
        EXPECT_EQ(outcomes[k].end, outcomes[0].end);
        EXPECT_EQ(outcomes[k].evaluations, outcomes[0].evaluations);
        EXPECT_EQ(outcomes[k].failed, outcomes[0].failed);
        EXPECT_EQ(outcomes[k].optimality, outcomes[0].optimality);
        EXPECT_EQ(rows[k], rows[0]);
      }
      EXPECT_LE(outcomes[0].evaluations, most + 20);
      if (most < 10000) continue;
      for (const double x : outcomes[0].x) EXPECT_NEAR(4 * x * (x * x - 1), -0.25, 1e-4);
      EXPECT_LT(outcomes[0].x[0], 0);
    }
  }
}

TEST(Optimise, TellsThatNoVariableChangesTheObjective) {
  DesignProblem problem{{0, 0}, {1, 1}, {0.5, 0.2}, 0, 0, {}};
  const auto of = [](double slope) {
    return [=](std::span<const double> x, bool) {
      DesignEvaluation e;
      e.values.objective = 3 + slope * (x[0] - 0.5) * (x[0] - 0.5);
      e.values.gradient = {2 * slope * (x[0] - 0.5), 0};
      return e;
    };
  };
  problem.evaluate = of(0);
  const DesignOutcome constant = optimise_design(problem, {});
  EXPECT_TRUE(constant.is_constant);
  EXPECT_EQ(constant.x, problem.start);
  problem.evaluate = of(1);  // stationary at the start
  EXPECT_FALSE(optimise_design(problem, {}).is_constant);
}

TEST(Optimise, RefusesProblemsThatAreNone) {
  DesignProblem problem = quadratic();
  problem.start = {2, 0};
  EXPECT_THROW(optimise_design(problem, {}), std::invalid_argument);
  problem = quadratic();
  problem.lower[0] = 1;
  EXPECT_THROW(optimise_design(problem, {}), std::invalid_argument);
}

// Every search has a memory of its own, so that the number of threads changes nothing.
TEST(Optimise, BeginsEverySearchWithAnEvaluationOfItsOwn) {
  for (const int threads : {1, 3}) {
    std::atomic<int> begun = 0, used = 0;
    DesignProblem problem = quadratic();
    problem.begin_search = [&, evaluate = problem.evaluate] {
      ++begun;
      return [&, evaluate, first = true](std::span<const double> x, bool gradients) mutable {
        used += first;
        first = false;
        return evaluate(x, gradients);
      };
    };
    problem.evaluate = nullptr;
    DesignOptions options;
    options.starts = 4;
    options.threads = threads;
    const DesignOutcome outcome = optimise_design(problem, options);
    EXPECT_EQ(outcome.end, DesignEnd::converged);
    EXPECT_NEAR(outcome.x.at(0), 0.5, 1e-6);
    EXPECT_EQ(begun, 4);
    EXPECT_EQ(used, 4);
  }
}

}  // namespace
}  // namespace catena::testing
