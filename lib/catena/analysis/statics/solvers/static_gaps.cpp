#include "catena/analysis/statics/solvers/static_gaps.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/statics/solvers/static_active_set.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double gap_turn = 1;
// Changes below this, length scales or rad, are followed by the exact K.
constexpr double followed_change = 0.3;
// No step is longer than this many sizes of the mechanism; one that has moved so many away is not held.
constexpr double largest_stride = 1, lost_sizes = 1e5;
// The smoothing begins with one of these, L being the size of the mechanism: where many gaps share a load a large t
// makes them act from a distance, with a small t their state alternates. It ends when the active set is certain.
constexpr double first_smoothings[] = {0.1, 0.03, 0.3};
constexpr double last_smoothing = 1e-8;
// Steps of t: the first factor, and the one that ends the search.
constexpr double first_cooling = 0.2, least_cooling = 0.97;
// A point is solved for a t when the change is below this, length scales or rad, and the residual below this part of t.
constexpr double arrived_change = 0.02, arrived_part = 0.1;
// Newton steps for it at all but the first t; if fewer than the second are needed, t decreases faster.
constexpr int most_steps = 8, quick_steps = 3;

// The smoothed complementarity of all gaps, in units.
class SmoothedGaps {
 public:
  SmoothedGaps(const StaticSystem& system, const GapUnits& scale) : system_(system), scale_(scale) {}

  /// Compliance d and right-hand side of every gap's row; other entries are left alone.
  void linearise(std::span<const double> lambda, double t, std::span<double> compliance, std::span<double> gap) const {
    for (int r : system_.plan().gap_rows) {
      const GapUnits u = units_of(system_, r, scale_);
      const double w = system_.phi()[at(r)] / u.gap, p = -lambda[at(r)] / u.force, d = w - p;
      const double root = std::hypot(d, 2 * t);
      // a, b: slopes by w and p; the smaller one without cancellation.
      const double small = 4 * t * t / (root * (root + std::abs(d))), large = (root + std::abs(d)) / root;
      const double a = d > 0 ? small : large, b = d > 0 ? large : small;
      compliance[at(r)] = b * u.gap / (a * u.force);
      gap[at(r)] = (b * p - w - p + root) * u.gap / a;
    }
  }
  /// The residual of the equations, in units.
  double left_over(std::span<const double> lambda, double t) const {
    double most = 0;
    for (int r : system_.plan().gap_rows) {
      const GapUnits u = units_of(system_, r, scale_);
      const double w = system_.phi()[at(r)] / u.gap, p = -lambda[at(r)] / u.force;
      most = std::max(most, std::abs(w + p - std::hypot(w - p, 2 * t)));
    }
    return most;
  }
  /// The multiplier that fits the present gap of row r: p - t^2 / p = -w.
  double fitting(int r, double t) const {
    const GapUnits u = units_of(system_, r, scale_);
    const double w = system_.phi()[at(r)] / u.gap, root = std::hypot(w, 2 * t);
    return -u.force * (w > 0 ? 2 * t * t / (root + w) : (root - w) / 2);
  }

 private:
  const StaticSystem& system_;
  GapUnits scale_;
};

// The larger side of the box that holds all bodies, at least the length scale.
double size_of(StaticSystem& system) {
  const Evaluator& evaluator = system.evaluator();
  Vec2<double> low = evaluator.ground_frame(0).origin(), high = low;
  for (int b = 1; b < system.plan().moving; ++b) {
    const Vec2<double> place = evaluator.ground_frame(b).origin();
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
  }
  return std::max({system.length(), high.x - low.x, high.y - low.y});
}

double farthest(std::span<const double> q, std::span<const double> start) {
  double most = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    if (k % 3 != 2) most = std::max(most, std::abs(q[k] - start[k]));
  }
  return most;
}

// Fills and factors the matrix, exact if allowed and if its inertia is that of a minimum; `exact` reports which.
bool factorize(StaticSystem& system, std::span<const double> lambda, bool may_be_exact, bool& exact) {
  exact = false;
  if (may_be_exact) {
    system.fill(lambda, Curvature::exact, 0);
    exact = system.factorize().ok() && system.matrix().negative_modes() == 0;
    if (exact) return true;
  }
  for (double shift = 0; shift < 1; shift = shift == 0 ? 1e-9 : shift * 1e3) {
    system.fill(lambda, Curvature::convex, shift * std::max(system.matrix().largest_stiffness(), 1e-300));
    if (system.factorize().ok()) return true;
  }
  return false;
}

// One search.
StaticOutcome follow_smoothing(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                               double first_smoothing, const StaticGapOptions& options) {
  StaticOutcome outcome;
  const Plan& plan = system.plan();
  const std::vector<double> start(q.begin(), q.end());
  std::vector<double> force(at(plan.columns)), gap(at(plan.rows)), compliance(at(plan.rows), 0.0), bent(at(plan.rows));
  // Multipliers of the equations from the mechanism without its gaps, forces of gaps from where they are.
  set.closed.assign(plan.gap_rows.size(), 0);
  system.close_gaps(set.closed);
  system.move_to(q);
  std::fill(lambda.begin(), lambda.end(), 0.0);
  if (!(system.has_springs() ? first_tensions(system, lambda) : first_multipliers(system, lambda))) {
    outcome.end = StaticEnd::singular;
    return outcome;
  }
  system.use_gaps();
  system.move_to(q);
  const double size = size_of(system);
  const SmoothedGaps gaps(system, {size, typical_force(system)});
  double t = first_smoothing;
  for (int r : plan.gap_rows) lambda[at(r)] = gaps.fitting(r, t);
  // The last point that was solved, and the factor of t from there.
  std::vector<double> q_before(q.begin(), q.end()), lambda_before(lambda.begin(), lambda.end());
  double t_before = t, cooling = first_cooling;
  bool near = false;
  int steps = 0;
  for (outcome.iterations = 1; outcome.iterations <= options.max_iterations; ++outcome.iterations) {
    ++system.evaluator().counters.iterations;
    if (system.is_cancelled()) {
      outcome.end = StaticEnd::cancelled;
      return outcome;
    }
    for (std::size_t r = 0; r < gap.size(); ++r) gap[r] = -system.phi()[r];
    gaps.linearise(lambda, t, compliance, gap);
    system.matrix().set_compliance(compliance);
    // A force below the one that fits its gap, or a pull, is temporary and must not enter K.
    bent.assign(lambda.begin(), lambda.end());
    for (int r : plan.gap_rows) bent[at(r)] = std::min(bent[at(r)], gaps.fitting(r, t));
    if (!factorize(system, bent, near, outcome.exact)) {
      outcome.end = StaticEnd::singular;
      return outcome;
    }
    for (std::size_t c = 0; c < force.size(); ++c) force[c] = -system.gradient()[c];
    const StaticStep step = system.solve(force, gap, near ? 1e-13 : 1e-9);
    const double change = system.change_norm(step.change);
    // Where almost nothing resists only the direction of a step is useful.
    const double factor =
        std::isfinite(change) ? std::min(1.0, largest_stride * size / (system.length() * change)) : 0.0;
    if (factor > 0) {
      system.foresee(step.change, factor, gap_turn);
      system.advance(q, step.change, factor, gap_turn);
      for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] += factor * (step.lambda[r] - lambda[r]);
      system.move_to(q);
    }
    outcome.step = change;
    if (const IterationTrace* trace = system.evaluator().trace)
      (*trace)("gaps", outcome.iterations, gaps.left_over(lambda, t), change);
    near = change <= followed_change;
    ++steps;
    if (farthest(q, start) > lost_sizes * size) {
      outcome.end = StaticEnd::unbounded;
      return outcome;
    }
    const bool first = t_before == t;
    if (change <= arrived_change && gaps.left_over(lambda, t) <= arrived_part * t) {
      if (t <= last_smoothing) {
        const int smoothed = outcome.iterations;
        system.forget_lengths();
        outcome = finish_with_gaps(system, q, lambda, set, options);
        outcome.iterations += smoothed;
        return outcome;
      }
      if (!first && steps <= quick_steps) cooling *= cooling;
      q_before.assign(q.begin(), q.end());
      lambda_before.assign(lambda.begin(), lambda.end());
      t_before = t;
    } else if (factor > 0 && steps < (first ? options.first_steps : most_steps)) {
      continue;
    } else {
      // The step was too long.
      cooling = std::sqrt(cooling);
      if (first || cooling > least_cooling) break;
      std::copy(q_before.begin(), q_before.end(), q.begin());
      std::copy(lambda_before.begin(), lambda_before.end(), lambda.begin());
      system.move_to(q);
      system.forget_lengths();
    }
    t = std::max(t_before * cooling, 0.5 * last_smoothing);
    steps = 0;
  }
  outcome.end = StaticEnd::slow;
  std::vector<double> residual(at(plan.columns));
  system.residual(lambda, residual);
  outcome.residual = system.force_norm(residual);
  return outcome;
}

}  // namespace

StaticOutcome solve_with_gaps(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                              const StaticGapOptions& options) {
  const std::vector<double> start(q.begin(), q.end());
  StaticOutcome outcome;
  int iterations = 0;
  for (const double t : first_smoothings) {
    std::copy(start.begin(), start.end(), q.begin());
    outcome = follow_smoothing(system, q, lambda, set, t, options);
    system.forget_lengths();
    iterations += outcome.iterations;
    if (outcome.converged() || outcome.end == StaticEnd::unbounded || outcome.end == StaticEnd::cancelled) break;
  }
  outcome.iterations = iterations;
  return outcome;
}

}  // namespace catena
