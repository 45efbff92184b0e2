#include "catena/analysis/statics/solvers/static_newton.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double newton_turn = 1;
// Changes, in length scales or rad: below the first the exact K is worth trying, below the second one more correction
// with the same factors reaches rounding.
constexpr double exact_change = 0.3;
constexpr double polished_change = 1e-4;
constexpr int polishing_steps = 4;
// Part of the residual that a correction may leave, rounding of forces, and the multiple of it that still counts as
// rounding.
constexpr double polishing_part = 1e-2, rounding_part = 1e-15, few_roundings = 10;
// Motion of a balanced start under the weights of the first multipliers, length scales or rad: forces are known to
// first_tolerance, and the weights are forces over the length.
constexpr double still = 1e-3;
// Stiffness assumed while the first tensions are found, where there is no load to derive it from, relative to the
// stiffest spring.
constexpr double softest_part = 1e-9;
// A step from a balanced point that leaves more than this part of the residual is rounding.
constexpr double no_gain = 0.5;
// Below this no further gain is possible.
constexpr double last_change = 1e-10;
// Multipliers beyond this many times the largest applied force, and the sum of all, belong to rows that depend on each
// other and contradict.
constexpr double largest_multiplier = 1e7, largest_of_sum = 1e5;
// Of the linearised equations, relative to the forces and the extent: the error of one step is removed by the next one
// and by the corrections at the end.
constexpr double step_tolerance = 1e-7, first_tolerance = 1e-4;
constexpr double largest_change = 1e14;

}  // namespace

bool first_multipliers(StaticSystem& system, std::span<double> lambda, bool exact) {
  system.fill_weights();
  if (!system.factorize().ok()) return false;
  StaticStep step = system.newton_step(exact ? 0 : first_tolerance);
  // Where almost nothing would move the forces may balance already, which only exact multipliers show.
  if (!exact && system.change_norm(step.change) <= still) step = system.newton_step(0);
  std::copy(step.lambda.begin(), step.lambda.end(), lambda.begin());
  return true;
}

bool first_tensions(StaticSystem& system, std::span<double> lambda) {
  std::fill(lambda.begin(), lambda.end(), 0.0);
  system.foresee();
  system.fill(lambda, Curvature::convex, 0);
  const double softest = softest_part * system.matrix().largest_stiffness();
  system.fill(lambda, Curvature::convex, std::max(system.dead_load() / system.length(), softest));
  if (!system.factorize().ok()) return false;
  StaticStep step = system.newton_step(first_tolerance);
  if (system.change_norm(step.change) <= still) step = system.newton_step(0);
  std::copy(step.lambda.begin(), step.lambda.end(), lambda.begin());
  system.foresee(step.change, 1, newton_turn);
  return true;
}

void polish(StaticSystem& system, std::span<double> q, std::span<double> lambda, StaticOutcome& outcome) {
  std::vector<double> residual(at(system.plan().columns)), gap(at(system.plan().rows)), q_before, lambda_before;
  std::vector<CurvePlace> places_before;
  const double force = system.force_size(), rounding = system.rounding_change();
  // In units of the possible rounding.
  const auto size = [&] {
    system.residual(lambda, residual);
    outcome.residual = system.force_norm(residual);
    return std::max(outcome.residual / (rounding_part * force), system.phi_norm() / rounding);
  };
  double now = size(), before = outcome.step;
  for (int k = 0; k < polishing_steps; ++k) {
    // The factors are those of the point before: the multipliers' change is solved for, not they themselves.
    for (double& r : residual) r = -r;
    for (std::size_t r = 0; r < gap.size(); ++r) gap[r] = -system.phi()[r];
    const double tolerance =
        polishing_part * std::max(outcome.residual / force, system.phi_norm() * system.length() / system.extent());
    const StaticStep step = system.solve(residual, gap, tolerance);
    const double change = system.change_norm(step.change);
    q_before.assign(q.begin(), q.end());
    lambda_before.assign(lambda.begin(), lambda.end());
    system.evaluator().curve_places(places_before);
    system.advance(q, step.change, 1, newton_turn);
    for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] += step.lambda[r];
    system.move_to(q);
    const double then = size();
    // Residuals of the size of rounding carry no information. The first correction removes the error of the Newton step
    // in soft modes; further ones are made while they shrink.
    const bool rounded = then <= std::max(4 * now, few_roundings);
    if (!(then < now || (rounded && (k == 0 || change < 0.1 * before)))) {
      std::copy(q_before.begin(), q_before.end(), q.begin());
      std::copy(lambda_before.begin(), lambda_before.end(), lambda.begin());
      system.evaluator().go_to_curve_places(places_before);
      system.move_to(q);
      size();
      return;
    }
    // The size of one more correction: each is shorter than the one before by the same factor.
    const double next = change * std::min(change / before, 1.0);
    outcome.step = before = change;
    now = then;
    if (next <= rounding && now <= few_roundings) return;
  }
}

StaticOutcome solve_by_newton(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                              const StaticNewtonOptions& options) {
  struct PresentLengths {
    StaticSystem& system;
    ~PresentLengths() { system.forget_lengths(); }
  };
  const PresentLengths at_the_end{system};
  StaticOutcome outcome;
  const Plan& plan = system.plan();
  std::vector<double> residual(at(plan.columns)), q_before(q.size()), lambda_before(lambda.size());
  std::vector<CurvePlace> places_before;
  system.move_to(q);
  const bool linear = system.has_linear_constraints();
  if (!options.warm) {
    std::fill(lambda.begin(), lambda.end(), 0.0);
    // Without second derivatives of constraints the first step gives the multipliers as well.
    const bool found =
        system.has_springs() ? first_tensions(system, lambda) : linear || first_multipliers(system, lambda);
    if (!found) {
      outcome.end = StaticEnd::singular;
      return outcome;
    }
  }
  bool near = options.warm || linear;
  outcome.step = largest_change;
  double force = 0;
  const auto measure = [&] {
    system.residual(lambda, residual);
    outcome.residual = system.force_norm(residual);
    force = system.force_scale(lambda);
  };
  const auto is_balanced = [&](double rounding) {
    return outcome.residual <= options.tolerance * force + rounding &&
           system.phi_norm() <= std::max(options.tolerance, 10 * system.rounding_change());
  };
  measure();
  bool balanced = is_balanced(0);
  for (outcome.iterations = 1; outcome.iterations <= options.max_iterations; ++outcome.iterations) {
    ++system.evaluator().counters.iterations;
    if (system.is_cancelled()) {
      outcome.end = StaticEnd::cancelled;
      return outcome;
    }
    bool minimum = false, factored = false;
    outcome.exact = false;
    if (near) {
      system.fill(lambda, Curvature::exact, 0);
      factored = system.factorize().ok();
      minimum = factored && system.matrix().negative_modes() == 0;
      outcome.exact = factored && (minimum || options.stationary);
    }
    if (!outcome.exact) {
      system.fill(lambda, Curvature::convex, 0);
      factored = system.factorize().ok();
      for (double shift = 1e-9; !factored && shift < 1; shift *= 1e3) {
        system.fill(lambda, Curvature::convex, shift * system.matrix().largest_stiffness());
        factored = system.factorize().ok();
      }
    }
    if (!factored) {
      outcome.end = balanced ? StaticEnd::stationary : StaticEnd::singular;
      return outcome;
    }
    const StaticStep step = system.newton_step(near ? step_tolerance : first_tolerance);
    const double change = system.change_norm(step.change);
    if (!(change < largest_change)) {
      outcome.end = balanced ? StaticEnd::stationary : StaticEnd::diverged;
      return outcome;
    }
    const double residual_before = outcome.residual;
    if (balanced) {
      std::copy(q.begin(), q.end(), q_before.begin());
      std::copy(lambda.begin(), lambda.end(), lambda_before.begin());
      system.evaluator().curve_places(places_before);
    }
    system.foresee(step.change, 1, newton_turn);
    system.advance(q, step.change, 1, newton_turn);
    std::copy(step.lambda.begin(), step.lambda.end(), lambda.begin());
    system.move_to(q);
    measure();
    // Along motions that nothing resists a step consists of rounding.
    if (balanced && change > polished_change && !(outcome.residual <= no_gain * residual_before)) {
      std::copy(q_before.begin(), q_before.end(), q.begin());
      std::copy(lambda_before.begin(), lambda_before.end(), lambda.begin());
      system.evaluator().go_to_curve_places(places_before);
      system.move_to(q);
      outcome.residual = residual_before;
      outcome.end = StaticEnd::stationary;
      return outcome;
    }
    outcome.step = change;
    if (const IterationTrace* trace = system.evaluator().trace)
      (*trace)("newton", outcome.iterations, outcome.residual, change);
    near = change <= exact_change;
    if (!(force <= std::max(largest_multiplier * system.load_size(), largest_of_sum * system.total_load()))) {
      outcome.end = StaticEnd::diverged;
      return outcome;
    }
    // A residual that looks like rounding of the stiffest spring may be the whole force of a soft one: the step shows
    // it.
    const auto is_small = [&] { return is_balanced(outcome.step <= last_change ? system.rounding_force() : 0); };
    balanced = is_balanced(0);
    // One step ends a linear problem, whatever its length.
    if (change > polished_change && !(linear && outcome.exact && is_small())) continue;
    polish(system, q, lambda, outcome);
    force = system.force_scale(lambda);
    if (is_small() || change <= last_change) {
      outcome.end = outcome.exact && minimum ? StaticEnd::minimum : StaticEnd::stationary;
      return outcome;
    }
  }
  outcome.end = StaticEnd::slow;
  return outcome;
}

}  // namespace catena
