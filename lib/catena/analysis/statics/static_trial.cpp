#include "catena/analysis/statics/static_trial.hpp"

#include <algorithm>
#include <utility>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/statics/solvers/endless_fall.hpp"
#include "catena/analysis/statics/solvers/static_descent.hpp"
#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/analysis/statics/solvers/static_nlopt.hpp"
#include "catena/analysis/statics/solvers/static_settling.hpp"
#include "catena/analysis/statics/solvers/static_steps.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps downhill from where Newton's full steps do not settle: more where there is more to move, until that takes some
// ten seconds.
constexpr int most_downhill_work = 20'000'000;
// Newton's method may move the result of another solver by this much, length scales or rad: more is another
// equilibrium.
constexpr double largest_polish = 0.05;
// Below this interior-point iterations only accumulate rounding: Newton's method does the rest.
constexpr double finest_barrier = 1e-10;
// Steps that do not converge soon rarely do: more are allowed only after other methods have failed. With more at once a
// chain over a drum takes 247 iterations in place of 145.
constexpr int few_first_steps = 40, most_first_steps = 80;
// Constraints that are missed by more than this part of the length were left out of a search: what a search meets it
// meets to its tolerance, 1e-8 unless another is asked for.
constexpr double missed = 1e-4;

const char* solver_of(StaticWay way) {
  switch (way) {
    case StaticWay::ipopt:
      return "ipopt";
    case StaticWay::nlopt:
      return "nlopt";
    case StaticWay::settling:
      return "settling";
    case StaticWay::valley:
    case StaticWay::newton:
      break;
  }
  return "newton";
}

}  // namespace

StaticOutcome StaticTrial::run(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way,
                               StaticResult& result) {
  result.solver = solver_of(way);
  if (system_.has_gaps()) return run_with_gaps(q, lambda, warm, way, result);
  const StaticOutcome outcome = run_smooth(q, lambda, warm, way);
  result.iterations += outcome.iterations;
  const bool is_refined = way == StaticWay::ipopt || way == StaticWay::nlopt || way == StaticWay::settling;
  return is_refined && outcome.converged() ? polish_by_newton(q, lambda, outcome) : outcome;
}

StaticOutcome StaticTrial::run_smooth(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way) {
  system_.move_to(q);
  if (way == StaticWay::ipopt || way == StaticWay::nlopt) return optimise(q, lambda, warm, way);
  if (way == StaticWay::settling) return solve_by_settling(system_, q, lambda, {.tolerance = options_.tolerance});
  if (way == StaticWay::valley && (system_.phi_norm() <= thresholds::assembled || assemble(q)))
    return solve_by_descent(system_, q, lambda, {.tolerance = options_.tolerance});
  StaticOutcome outcome = solve_by_newton(
      system_, q, lambda, {.tolerance = options_.tolerance, .warm = warm, .stationary = options_.stationary});
  if (outcome.end != StaticEnd::slow) return outcome;
  // Full steps that alternate have lowered the energy all the same: descent continues from their end.
  const int columns = std::max(system_.plan().columns, 1), steps = outcome.iterations;
  const int most =
      std::max(descent::most_steps, std::min(descent::most_steps + 2 * columns, most_downhill_work / columns));
  outcome = solve_by_descent(system_, q, lambda, {.max_iterations = most, .tolerance = options_.tolerance});
  outcome.iterations += steps;
  return outcome;
}

bool StaticTrial::assemble(std::vector<double>& q) {
  std::vector<double> start = q;
  const std::vector<CurvePlace> places = system_.evaluator().curve_places();
  if (Assembler(system_.evaluator()).assemble(start).ok()) {
    q = std::move(start);
    return true;
  }
  system_.evaluator().go_to_curve_places(places);
  return false;
}

// Where constraints are singular and do not hold, as in a sketch that is drawn flat, some seem to depend on others, and
// what is found without them misses them: the search begins once more where the sketch is assembled.
StaticOutcome StaticTrial::optimise_by_nlopt(std::vector<double>& q, std::vector<double>& lambda) {
  std::vector<double> start = q;
  const bool holds = system_.has_gaps() || system_.phi_norm() <= thresholds::assembled;
  StaticOutcome outcome = solve_by_nlopt(system_, q, lambda, {.tolerance = options_.tolerance});
  const bool found = outcome.converged() && system_.phi_norm() <= missed;
  if (holds || found || outcome.end == StaticEnd::cancelled) return outcome;
  system_.move_to(start);
  if (!assemble(start)) {
    system_.move_to(q);
    return outcome;
  }
  const int iterations = outcome.iterations;
  q = std::move(start);
  outcome = solve_by_nlopt(system_, q, lambda, {.tolerance = options_.tolerance});
  outcome.iterations += iterations;
  return outcome;
}

// Minimisers give an energy up that has fallen far: whether it falls for ever is another question.
StaticOutcome StaticTrial::optimise(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way) {
  const std::vector<double> start = q;
  StaticOutcome outcome =
      way == StaticWay::nlopt
          ? optimise_by_nlopt(q, lambda)
          : solve_by_ipopt(
                system_, q, lambda,
                {.tolerance = std::max(options_.tolerance, finest_barrier), .warm = warm, .verbose = options_.verbose});
  if (outcome.end != StaticEnd::unbounded) return outcome;
  std::vector<double> way_made(at(system_.plan().columns));
  for (std::size_t c = 0; c < way_made.size(); ++c) {
    const std::size_t k = at(system_.plan().coordinate[c]);
    way_made[c] = q[k] - start[k];
  }
  if (!falls_for_ever(system_, q, way_made)) outcome.end = StaticEnd::diverged;
  return outcome;
}

StaticOutcome StaticTrial::run_with_gaps(std::vector<double>& q, std::vector<double>& lambda, bool warm, StaticWay way,
                                         StaticResult& result) {
  const StaticGapOptions exact{.first_steps = result.iterations == 0 ? few_first_steps : most_first_steps,
                               .tolerance = std::min(options_.tolerance, thresholds::assembled)};
  StaticOutcome outcome;
  if (way == StaticWay::ipopt || way == StaticWay::nlopt) {
    system_.use_gaps();
    system_.move_to(q);
    outcome = optimise(q, lambda, warm, way);
    result.iterations += outcome.iterations;
    return outcome.converged() ? finish_with_gaps(system_, q, lambda, result.gaps, exact) : outcome;
  }
  if (way == StaticWay::settling) {
    system_.move_to(q);
    outcome = solve_by_settling(system_, q, lambda, result.gaps, {.tolerance = options_.tolerance});
    result.iterations += outcome.iterations;
    return outcome.converged() ? finish_with_gaps(system_, q, lambda, result.gaps, exact) : outcome;
  }
  if (warm) {
    // Where the closed gaps stay closed this suffices for a small change of parameters.
    const std::vector<double> before = q, multipliers = lambda;
    const std::vector<CurvePlace> places = system_.evaluator().curve_places();
    outcome = finish_with_gaps(system_, q, lambda, result.gaps, exact);
    result.iterations += outcome.iterations;
    if (outcome.converged()) return outcome;
    q = before;
    lambda = multipliers;
    system_.evaluator().go_to_curve_places(places);
  }
  outcome = solve_with_gaps(system_, q, lambda, result.gaps, exact);
  result.iterations += outcome.iterations;
  return outcome;
}

// Refines the result of another solver to rounding; keeps it where Newton's method would move to another equilibrium.
StaticOutcome StaticTrial::polish_by_newton(std::vector<double>& q, std::vector<double>& lambda,
                                            StaticOutcome outcome) {
  KeptPlace found;
  found.keep(system_, q, lambda);
  // To rounding, whatever the tolerance: the steps cost little beside those before.
  const StaticOutcome polished = solve_by_newton(
      system_, q, lambda, {.max_iterations = 20, .tolerance = force_rounding, .warm = true, .stationary = true});
  std::vector<double> change(at(system_.plan().columns));
  for (std::size_t c = 0; c < change.size(); ++c) {
    const std::size_t k = at(system_.plan().coordinate[c]);
    change[c] = q[k] - found.q[k];
  }
  const bool better = polished.converged() || polished.residual < outcome.residual;
  if (better && system_.change_norm(change) <= largest_polish) {
    outcome.residual = polished.residual;
    outcome.step = polished.step;
    return outcome;
  }
  found.take_back(system_, q, lambda);
  return outcome;
}

}  // namespace catena
