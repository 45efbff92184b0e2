#include "catena/analysis/statics/solvers/static_settling.hpp"

#include <algorithm>
#include <cmath>

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

// The unsymmetric matrix, its pattern from the plan.
class Tangent {
 public:
  explicit Tangent(StaticSystem& system) : system_(system) {
    const Plan& plan = system.plan();
    const int size = plan.columns + plan.rows;
    std::vector<MatrixEntry> places;
    for (int k = 0; k < size; ++k) places.push_back({k, k});
    for (int c = 0; c < plan.columns; ++c) {
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
        const int row = plan.columns + plan.jacobian.row_index[at(k)];
        places.push_back({row, c});
        places.push_back({c, row});
      }
    }
    const std::size_t first = places.size();
    visit([&](int row, int column, double) { places.push_back({row, column}); });
    SlottedPattern built = build_pattern(size, size, places);
    slot_.assign(built.slot.begin(), built.slot.begin() + static_cast<std::ptrdiff_t>(first));
    element_slot_.assign(built.slot.begin() + static_cast<std::ptrdiff_t>(first), built.slot.end());
    values_.resize(built.pattern.row_index.size());
    usable_ = factorization_.analyze(built.pattern, Kernel::automatic, system.evaluator().counters).ok();
  }

  bool factorize(std::span<const double> lambda, double damping, double stiffness) {
    const Plan& plan = system_.plan();
    lambda_ = lambda;
    std::fill(values_.begin(), values_.end(), 0.0);
    std::size_t k = 0;
    for (int c = 0; c < plan.columns; ++c, ++k) {
      const int coordinate = plan.coordinate[at(c)];
      const double arm = coordinate % 3 == 2 ? system_.radius()[at(coordinate / 3)] : 1;
      values_[at(slot_[k])] += damping * arm * arm;
    }
    for (int r = 0; r < plan.rows; ++r, ++k) values_[at(slot_[k])] -= regularisation / stiffness;
    for (double value : system_.jacobian()) {
      values_[at(slot_[k++])] += value;
      values_[at(slot_[k++])] += value;
    }
    k = 0;
    visit([&](int, int, double value) { values_[at(element_slot_[k++])] += value; });
    return usable_ && factorization_.factorize(values_, system_.evaluator().counters).ok();
  }

  bool solve(std::span<double> x) {
    return factorization_.solve_checked(values_, x, system_.evaluator().counters).ok();
  }

 private:
  // All entries of -dQ/dq and of sum lambda Phi_qq over columns.
  template <class F>
  void visit(F&& entry) {
    const Plan& plan = system_.plan();
    const auto element = [&](int i, int j, const ElementMatrix& m) {
      for (int a = 0; a < 6; ++a) {
        const int body_a = a < 3 ? i : j;
        const int row = body_a >= 0 && body_a < plan.moving ? plan.column[at(3 * body_a + a % 3)] : -1;
        for (int b = 0; b < 6 && row >= 0; ++b) {
          const int body_b = b < 3 ? i : j;
          const int column = body_b >= 0 && body_b < plan.moving ? plan.column[at(3 * body_b + b % 3)] : -1;
          if (column >= 0) entry(row, column, m[at(6 * a + b)]);
        }
      }
    };
    if (lambda_.empty()) lambda_ = zero_ = std::vector<double>(at(plan.rows) + 1, 0.0);
    system_.evaluator().visit_stiffness({}, element);
    system_.evaluator().visit_constraint_hessians(lambda_, element);
  }

  StaticSystem& system_;
  Factorization factorization_;
  std::span<const double> lambda_;
  std::vector<double> zero_, values_;
  std::vector<int> slot_, element_slot_;
  bool usable_ = false;
};

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
  Tangent tangent(system);
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
    if (!tangent.factorize(lambda, damping, stiffness)) {
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
