#include "catena/analysis/static_newton.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

constexpr double largest_turn = 1;
// Changes, in length scales or rad: below the first the exact K is worth trying, below the second one more correction
// with the same factors reaches rounding.
constexpr double near_change = 0.3;
constexpr double polishing_change = 1e-4;
constexpr int polishing_steps = 4;
// What a correction may leave of the residual, what rounding leaves of forces, and how many times that is rounding too.
constexpr double polishing_part = 1e-2, rounding_part = 1e-15, few_roundings = 10;
// Below this nothing more is to be had.
constexpr double last_change = 1e-10;
// Multipliers beyond this many times the largest applied force, and the sum of all, belong to rows that depend on each
// other and contradict.
constexpr double largest_multiplier = 1e7, largest_of_sum = 1e5;
// Of the linearised equations, relative to the forces and the extent: what one step leaves, the next one and the
// corrections at the end remove.
constexpr double step_tolerance = 1e-7, first_tolerance = 1e-4;
constexpr double largest_change = 1e14;

}  // namespace

bool first_multipliers(StaticSystem& system, std::span<double> lambda) {
  system.fill_weights();
  if (!system.factorize().ok()) return false;
  const StaticStep step = system.newton_step(first_tolerance);
  std::copy(step.lambda.begin(), step.lambda.end(), lambda.begin());
  return true;
}

void polish(StaticSystem& system, std::span<double> q, std::span<double> lambda, StaticOutcome& outcome) {
  std::vector<double> residual(at(system.plan().columns)), gap(at(system.plan().rows)), q_before, lambda_before;
  const double force = system.force_size(), rounding = system.rounding_change();
  // In units of what rounding may leave.
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
    system.advance(q, step.change, 1, largest_turn);
    for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] += step.lambda[r];
    system.move_to(q);
    const double then = size();
    // Residuals of rounding's size say nothing any more. What the Newton step left in soft modes the first correction
    // removes; further ones are worth it while they shrink.
    const bool rounded = then <= std::max(4 * now, few_roundings);
    if (!(then < now || (rounded && (k == 0 || change < 0.1 * before)))) {
      std::copy(q_before.begin(), q_before.end(), q.begin());
      std::copy(lambda_before.begin(), lambda_before.end(), lambda.begin());
      system.move_to(q);
      size();
      return;
    }
    // What one more correction would bring: each is shorter than the one before by the same factor.
    const double next = change * std::min(change / before, 1.0);
    outcome.step = before = change;
    now = then;
    if (next <= rounding && now <= few_roundings) return;
  }
}

StaticOutcome solve_by_newton(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                              const StaticNewtonOptions& options) {
  StaticOutcome outcome;
  const Plan& plan = system.plan();
  std::vector<double> residual(at(plan.columns));
  system.move_to(q);
  const bool linear = system.has_linear_constraints();
  if (!options.warm) {
    std::fill(lambda.begin(), lambda.end(), 0.0);
    // Without second derivatives of constraints the first step gives the multipliers as well.
    if (!linear && !first_multipliers(system, lambda)) {
      outcome.end = StaticEnd::singular;
      return outcome;
    }
  }
  bool near = options.warm || linear;
  outcome.step = largest_change;
  for (outcome.iterations = 1; outcome.iterations <= options.max_iterations; ++outcome.iterations) {
    ++system.evaluator().counters.iterations;
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
      outcome.end = StaticEnd::singular;
      return outcome;
    }
    const StaticStep step = system.newton_step(near ? step_tolerance : first_tolerance);
    const double change = system.change_norm(step.change);
    if (!(change < largest_change)) {
      outcome.end = StaticEnd::diverged;
      return outcome;
    }
    system.advance(q, step.change, 1, largest_turn);
    std::copy(step.lambda.begin(), step.lambda.end(), lambda.begin());
    system.move_to(q);
    system.residual(lambda, residual);
    outcome.residual = system.force_norm(residual);
    outcome.step = change;
    if (const IterationTrace* trace = system.evaluator().trace)
      (*trace)("newton", outcome.iterations, outcome.residual, change);
    near = change <= near_change;
    if (!(system.force_scale(lambda) <=
          std::max(largest_multiplier * system.load_size(), largest_of_sum * system.total_load()))) {
      outcome.end = StaticEnd::diverged;
      return outcome;
    }
    // What looks like rounding beside the stiffest spring may be all that a soft one holds: the step tells.
    const auto is_small = [&] {
      const double rounding = outcome.step <= last_change ? system.rounding_force() : 0;
      return outcome.residual <= options.tolerance * system.force_scale(lambda) + rounding &&
             system.phi_norm() <= std::max(options.tolerance, 10 * system.rounding_change());
    };
    // One step ends a linear problem, whatever its length.
    if (change > polishing_change && !(linear && outcome.exact && is_small())) continue;
    polish(system, q, lambda, outcome);
    if (is_small() || change <= last_change) {
      outcome.end = outcome.exact && minimum ? StaticEnd::minimum : StaticEnd::stationary;
      return outcome;
    }
  }
  outcome.end = StaticEnd::slow;
  return outcome;
}

}  // namespace catena
