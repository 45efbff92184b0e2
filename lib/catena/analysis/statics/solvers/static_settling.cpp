#include "catena/analysis/statics/solvers/static_settling.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/static_tangent.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double settling_turn = 0.5;
// Of a step, in extents of the scene.
constexpr double largest_travel = 0.5;
// E times the stiffness.
constexpr double regularisation = 1e-11;
// Growth of the residual allowed in an accepted step, and the change of the damping from step to step.
constexpr double tolerated_growth = 3, fastest_fading = 0.05, settling_stiffening = 8;
constexpr double largest_damping = 1e12, least_damping = 1e-14;
constexpr double settling_lost_extents = 1e5;
// Without damping no further gain is possible below this, length scales or rad.
constexpr double settling_last_change = 1e-10;

}  // namespace

StaticOutcome solve_by_settling(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                                const StaticSettlingOptions& options) {
  StaticOutcome outcome;
  const Plan& plan = system.plan();
  const std::size_t columns = at(plan.columns);
  system.move_to(q);
  if (!first_multipliers(system, lambda)) {
    outcome.end = StaticEnd::singular;
    return outcome;
  }
  StaticTangent tangent(system);
  std::vector<double> x(columns + at(plan.rows)), residual(columns);
  std::vector<double> q_before, lambda_before;
  const std::vector<double> start(q.begin(), q.end());
  const double extent = system.extent();
  const double force = std::max(system.force_scale(lambda), 1e-200), stiffness = force / system.length();
  const auto size = [&] {
    system.residual(lambda, residual);
    outcome.residual = system.force_norm(residual);
    return outcome.residual / force + system.phi_norm();
  };
  double damping = stiffness, now = size();
  for (outcome.iterations = 1; outcome.iterations <= options.max_iterations; ++outcome.iterations) {
    ++system.evaluator().counters.iterations;
    if (system.is_cancelled()) {
      outcome.end = StaticEnd::cancelled;
      return outcome;
    }
    tangent.fill(lambda, damping, regularisation / stiffness);
    if (!tangent.factorize()) {
      damping = std::max(settling_stiffening * damping, 1e-6 * stiffness);
      if (damping > largest_damping * stiffness) break;
      continue;
    }
    for (std::size_t c = 0; c < columns; ++c) x[c] = -residual[c];
    for (int r = 0; r < plan.rows; ++r) x[columns + at(r)] = -system.phi()[at(r)];
    const bool solved = tangent.solve(x);
    const std::span<const double> change(x.data(), columns);
    double turn = 0, travel = 0;
    for (int c = 0; c < plan.columns; ++c) {
      double& largest = plan.coordinate[at(c)] % 3 == 2 ? turn : travel;
      largest = std::max(largest, std::abs(change[at(c)]));
    }
    const double factor = std::min({1.0, settling_turn / turn, largest_travel * extent / travel});
    q_before.assign(q.begin(), q.end());
    lambda_before.assign(lambda.begin(), lambda.end());
    double then = now;
    if (solved && std::isfinite(turn + travel)) {
      system.advance(q, change, factor, settling_turn);
      for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] += factor * x[columns + r];
      system.move_to(q);
      outcome.step = system.change_norm(change);
      then = size();
      if (const IterationTrace* trace = system.evaluator().trace)
        (*trace)("settling", outcome.iterations, outcome.residual, outcome.step);
    }
    const bool kept = solved && then <= tolerated_growth * now + options.tolerance;
    if (!kept) {
      std::copy(q_before.begin(), q_before.end(), q.begin());
      std::copy(lambda_before.begin(), lambda_before.end(), lambda.begin());
      system.move_to(q);
      now = size();
      damping = std::max(settling_stiffening * damping, 1e-6 * stiffness);
      if (damping > largest_damping * stiffness) break;
      continue;
    }
    const double ratio = then / std::max(now, 1e-300);
    damping *= factor < 1 ? 2 : std::clamp(ratio, fastest_fading, settling_stiffening);
    if (damping < least_damping * stiffness) damping = 0;
    now = then;
    for (std::size_t k = 0; k < q.size(); ++k) {
      if (k % 3 != 2 && std::abs(q[k] - start[k]) > settling_lost_extents * extent) {
        outcome.end = StaticEnd::unbounded;
        return outcome;
      }
    }
    // Rounding of the stiffest spring may be the whole force of a soft one: then the step decides.
    const double scale = std::max(system.force_scale(lambda), force);
    const double rounding = damping == 0 && outcome.step <= settling_last_change ? system.rounding_force() : 0;
    if (outcome.residual <= options.tolerance * scale + rounding &&
        system.phi_norm() <= std::max(options.tolerance, 10 * system.rounding_change())) {
      outcome.end = StaticEnd::stationary;
      return outcome;
    }
  }
  outcome.end = StaticEnd::slow;
  return outcome;
}

}  // namespace catena
