#include "catena/analysis/statics/solvers/static_descent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/spectrum/motion_groups.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double largest_turn = 0.7;
constexpr double smallest_factor = 1e-4;
// Shifts of K: the first relative to rounding of the largest stiffness or to force / extent, the last relative to the
// largest stiffness. Between them a soft support of a stiff part must be distinguished from no support.
constexpr double first_of_rounding = 1e-15, first_of_force = 1e-6, largest_shift = 1e6;
// Growth of the shift where the inertia is not that of a minimum, and where the energy did not decrease.
constexpr double stiffening = 32, shortening = 8;
// A short step ends the search if it is exact, or leaves no more than this part of the forces.
constexpr double stationary_part = 1e-7;
constexpr double sufficient_decrease = 1e-4;
constexpr double polishing_change = 1e-6;
// Constraints are met to this, in length scales or rad, between steps.
constexpr double restored = 1e-10;
// Curvature along a step below this part of the sum of its terms' magnitudes is rounding.
constexpr double neutral_part = 1e-10;
// A mechanism that has moved this many extents, or turned this many radians, downhill is not held.
constexpr double lost_extents = 1e5, lost_turns = 1e4;

struct Travel {
  double turn = 0, length = 0;  // largest of all bodies
};

Travel travel_of(const Plan& plan, std::span<const double> change) {
  Travel t;
  for (int c = 0; c < plan.columns; ++c) {
    double& largest = plan.coordinate[at(c)] % 3 == 2 ? t.turn : t.length;
    largest = std::max(largest, std::abs(change[at(c)]));
  }
  return t;
}

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

bool is_lost(std::span<const double> q, std::span<const double> start, double extent) {
  double turn = 0, length = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    double& largest = k % 3 == 2 ? turn : length;
    largest = std::max(largest, std::abs(q[k] - start[k]));
  }
  return length > lost_extents * extent || turn > lost_turns;
}

}  // namespace

bool restore_constraints(StaticSystem& system, std::span<double> q) {
  const Plan& plan = system.plan();
  system.move_to(q);
  const std::vector<double> no_force(at(plan.columns), 0.0), predicted(q.begin(), q.end());
  std::vector<double> gap(at(plan.rows));
  const double enough = std::max(restored, 10 * system.rounding_change());
  // With the present factors as long as they converge; then, as beyond a singular position, with new ones at every
  // step.
  for (const bool anew : {false, true}) {
    // A trial further on may have reached a configuration that cannot be factored (coinciding centres of gears).
    if (!anew && !system.has_factors()) continue;
    double before = system.phi_norm();
    for (int k = 0; k < 12; ++k) {
      if (before <= enough) return true;
      if (anew) {
        system.fill_weights();
        if (!system.factorize().ok()) return false;
      }
      for (std::size_t r = 0; r < gap.size(); ++r) gap[r] = -system.phi()[r];
      const StaticStep step = system.solve(no_force, gap, 1e-3);
      if (!(system.change_norm(step.change) < 10)) break;
      system.advance(q, step.change, 1, 1);
      system.move_to(q);
      const double now = system.phi_norm();
      if (!(now <= 0.7 * before)) break;
      before = now;
    }
    if (system.phi_norm() <= enough) return true;
    if (!anew) {
      std::copy(predicted.begin(), predicted.end(), q.begin());
      system.move_to(q);
    }
  }
  return false;
}

StaticOutcome solve_by_descent(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                               const StaticDescentOptions& options) {
  StaticOutcome outcome;
  const Plan& plan = system.plan();
  const std::size_t columns = at(plan.columns);
  std::vector<double> residual(columns), gradient(columns), change(columns), product(columns), trial(q.size()),
      next_lambda(at(plan.rows));
  const std::vector<double> start(q.begin(), q.end());
  std::vector<CurvePlace> curve_places;
  system.move_to(q);
  std::fill(lambda.begin(), lambda.end(), 0.0);
  // Where constraints have no second derivatives the first step needs no multipliers.
  const bool prepare = !system.has_linear_constraints() || system.phi_norm() > restored;
  if (prepare && (!first_multipliers(system, lambda, true) || !restore_constraints(system, q))) {
    outcome.end = StaticEnd::singular;
    return outcome;
  }
  const double extent = system.extent(), load = system.force_norm(system.gradient());
  const auto measure = [&] {
    system.residual(lambda, residual);
    outcome.residual = system.force_norm(residual);
  };
  measure();
  double reach = 1, last_shift = 0;
  double energy = system.energy(), energy_size = std::abs(energy);
  const auto tell = [&] {
    if (const IterationTrace* trace = system.evaluator().trace)
      (*trace)("downhill", outcome.iterations, outcome.residual, outcome.step);
  };
  for (outcome.iterations = 1; outcome.iterations <= options.max_iterations; ++outcome.iterations) {
    ++system.evaluator().counters.iterations;
    if (system.is_cancelled()) {
      outcome.end = StaticEnd::cancelled;
      return outcome;
    }
    const bool balanced = outcome.residual <= options.tolerance * system.force_scale(lambda);
    // The exact K, stiffened until its inertia is that of a minimum and a step can be made.
    bool accepted = false;
    double stiffest = 0, loads = 0;
    for (double shift = 0; !accepted && std::isfinite(shift) && shift <= largest_shift * std::max(stiffest, loads);) {
      system.fill(lambda, Curvature::exact, shift);
      const bool minimum = system.factorize().ok() && system.matrix().negative_modes() == 0;
      outcome.exact = minimum && shift == 0;
      const double used = shift;
      if (shift == 0) {
        stiffest = system.matrix().largest_stiffness();
        loads = system.force_size() / extent;
        shift = std::max({first_of_rounding * stiffest, first_of_force * loads, last_shift / 16});
      } else {
        shift *= minimum ? shortening : stiffening;
      }
      if (!minimum) continue;
      const StaticStep step = system.newton_step(1e-12);
      outcome.step = system.change_norm(step.change);
      if (!std::isfinite(outcome.step)) continue;
      std::copy(step.change.begin(), step.change.end(), change.begin());
      std::copy(step.lambda.begin(), step.lambda.end(), next_lambda.begin());
      if (outcome.step <= polishing_change) {
        system.advance(q, change, 1, 1);
        std::copy(next_lambda.begin(), next_lambda.end(), lambda.begin());
        system.move_to(q);
        polish(system, q, lambda, outcome);
        tell();
        const double force = std::max(system.force_scale(lambda), load);
        outcome.end = outcome.exact                                 ? StaticEnd::minimum
                      : outcome.residual <= stationary_part * force ? StaticEnd::stationary
                                                                    : StaticEnd::slow;
        return outcome;
      }
      std::copy(system.gradient().begin(), system.gradient().end(), gradient.begin());
      const double slope = dot(gradient, change);
      // On the constraints the slope is minus the curvature along the step. Where both are rounding the motion is
      // neutral and the step has no meaning: if forces balance the point is kept, else the shift limits the motion.
      bool neutral = used == 0 && -slope <= neutral_part * system.matrix().absolute_quadratic(change);
      if (used == 0 && balanced && !neutral) {
        // Terms that cancel within K, as those of a counterweight, do not appear there, and a balanced slope is itself
        // rounding.
        system.matrix().multiply_stiffness(change, product);
        neutral = dot(change, product) <= StiffnessFloor(system, lambda, 0)(change);
      }
      if (neutral) {
        if (!balanced) continue;
        outcome.end = StaticEnd::stationary;
        return outcome;
      }
      const Travel travel = travel_of(plan, change);
      double factor = std::min({1.0, reach * largest_turn / travel.turn, reach * extent / travel.length});
      const bool clipped = factor < 1;
      // The energy is a sum of large terms: a smaller change is rounding.
      const double noise = 1e-14 * (energy_size + system.force_size() * extent);
      system.evaluator().curve_places(curve_places);
      for (; factor > smallest_factor; factor /= 2) {
        std::copy(q.begin(), q.end(), trial.begin());
        system.advance(trial, change, factor, std::numeric_limits<double>::infinity());
        if (!restore_constraints(system, trial)) {
          system.evaluator().go_to_curve_places(curve_places);
          continue;
        }
        const double then = system.energy();
        if (then <= energy + sufficient_decrease * factor * std::min(slope, 0.0) + noise) {
          energy = then;
          energy_size = std::max(energy_size, std::abs(then));
          accepted = true;
          last_shift = used;
          // Steps that reach the limit double it: an energy without a minimum is then recognised after few steps.
          if (clipped) reach *= 2;
          break;
        }
        reach = std::max(reach / 2, 1.0);
        // The trial that was rejected may have found contacts far from here.
        system.evaluator().go_to_curve_places(curve_places);
      }
      system.move_to(accepted ? std::span<const double>(trial) : std::span<const double>(q));
    }
    if (!accepted) {
      outcome.end = StaticEnd::slow;
      return outcome;
    }
    std::copy(trial.begin(), trial.end(), q.begin());
    std::copy(next_lambda.begin(), next_lambda.end(), lambda.begin());
    measure();
    tell();
    if (is_lost(q, start, extent)) {
      outcome.end = StaticEnd::unbounded;
      return outcome;
    }
  }
  outcome.end = StaticEnd::slow;
  return outcome;
}

}  // namespace catena
