#include "catena/analysis/statics/solvers/static_ipopt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catena/analysis/balance/static_hessian.hpp"
#include "catena/analysis/minimiser/ipopt_program.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of a start at a singular position: length scales or rad.
constexpr double smallest_disturbance = 1e-3;
// Solutions of Ipopt must balance to this part of the forces, and meet the constraints to it.
constexpr double rough = 1e-5;

// The scaled problem in Ipopt's interface. Vectors x over columns, g over the equations that are kept.
class Problem final : public IpoptProgram {
 public:
  Problem(StaticSystem& system, std::span<double> q, std::span<double> lambda, bool warm)
      : system_(system), hessian_(system), q_(q), lambda_(lambda), warm_(warm) {
    const Plan& plan = system.plan();
    system.move_to(q);
    start_.resize(at(plan.columns));
    for (int c = 0; c < plan.columns; ++c) start_[at(c)] = q[at(plan.coordinate[at(c)])];
    trial_.assign(q.begin(), q.end());
    length_ = scene_extent();
    double load = 0;
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)];
      load += std::abs(system.gradient()[at(c)]) / (coordinate % 3 == 2 ? system.radius()[at(coordinate / 3)] : 1);
    }
    energy_ = (load > 0 ? load : 1) * length_;
    keep_independent_rows();
    row_multiplier_.resize(at(plan.rows));
  }

  int iterations() const { return iterations_; }

  Size size() const override {
    return {static_cast<int>(start_.size()), static_cast<int>(row_.size()), static_cast<int>(entry_.size()),
            static_cast<int>(hessian_.slot.size())};
  }
  void bounds(std::span<double> x_low, std::span<double> x_high, std::span<double> g_low,
              std::span<double> g_high) override {
    std::fill(x_low.begin(), x_low.end(), -ipopt_no_bound);
    std::fill(x_high.begin(), x_high.end(), ipopt_no_bound);
    for (std::size_t k = 0; k < g_low.size(); ++k) {
      const RowSide side = system_.side(row_[k]);
      g_low[k] = side == RowSide::at_most ? -ipopt_no_bound : 0;
      g_high[k] = side == RowSide::at_least ? ipopt_no_bound : 0;
    }
  }
  void start(std::span<double> x, std::span<double> lambda) override {
    for (std::size_t c = 0; c < x.size(); ++c) x[c] = start_[c] / unit(static_cast<int>(c));
    for (std::size_t k = 0; k < lambda.size(); ++k)
      lambda[k] = lambda_[at(row_[k])] * row_unit(static_cast<int>(k)) / energy_;
  }
  double objective(const double* x) override {
    move_to(x);
    return system_.energy() / energy_;
  }
  void gradient(const double* x, std::span<double> out) override {
    move_to(x);
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = system_.gradient()[c] * unit(static_cast<int>(c)) / energy_;
  }
  void rows(const double* x, std::span<double> g) override {
    move_to(x);
    for (std::size_t k = 0; k < g.size(); ++k) g[k] = system_.phi()[at(row_[k])] / row_unit(static_cast<int>(k));
  }
  Place jacobian_place(int entry) const override { return {entry_[at(entry)].row, entry_[at(entry)].column}; }
  void jacobian(const double* x, std::span<double> values) override {
    move_to(x);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const Entry& e = entry_[k];
      values[k] = system_.jacobian()[at(e.slot)] * unit(e.column) / row_unit(e.row);
    }
  }
  Place hessian_place(int entry) const override { return {hessian_.row[at(entry)], hessian_.column[at(entry)]}; }
  void hessian(const double* x, double factor, const double* lambda, std::span<double> values) override {
    move_to(x);
    for (std::size_t k = 0; k < row_.size(); ++k)
      row_multiplier_[at(row_[k])] = lambda[k] * energy_ / row_unit(static_cast<int>(k));
    hessian_.evaluate(factor, row_multiplier_);
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = hessian_.value[k] * unit(hessian_.row[k]) * unit(hessian_.column[k]) / energy_;
  }
  bool go_on(int iteration) override {
    iterations_ = iteration;
    ++system_.evaluator().counters.iterations;
    return !system_.is_cancelled();
  }
  void finish(const double* x, const double* lambda) override {
    move_to(x);
    std::copy(trial_.begin(), trial_.end(), q_.begin());
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
    for (std::size_t k = 0; k < row_.size(); ++k)
      lambda_[at(row_[k])] = lambda[k] * energy_ / row_unit(static_cast<int>(k));
  }

 private:
  struct Entry {
    int row, column, slot;
  };

  // Equations that follow from others at every configuration are dropped: those that still do near the start. A start
  // at which more of them depend on each other, as of a straight chain, is displaced a little.
  void keep_independent_rows() {
    const Plan& plan = system_.plan();
    std::vector<double> first(lambda_.size()), beside = trial_, near = trial_;
    unsigned seed = 1;
    for (int c = 0; c < plan.columns; ++c) {
      seed = seed * 1664525u + 1013904223u;
      const double noise = (static_cast<double>(seed >> 8) / (1 << 23) - 1) * unit(c);
      beside[at(plan.coordinate[at(c)])] += 0.1 * noise;
      near[at(plan.coordinate[at(c)])] += smallest_disturbance * noise;
    }
    std::vector<char> dropped(at(plan.rows), 0);
    const auto dependent_rows = [&](std::span<const double> place) {
      system_.move_to(place);
      return first_multipliers(system_, first) ? system_.matrix().dependent_rows() : std::vector<int>();
    };
    const std::vector<int> everywhere = dependent_rows(beside);
    for (int r : everywhere) dropped[at(r)] = system_.side(r) == RowSide::both;
    if (dependent_rows(trial_).size() > everywhere.size()) {
      for (int c = 0; c < plan.columns; ++c) start_[at(c)] = near[at(plan.coordinate[at(c)])];
      dependent_rows(near);
    }
    if (!warm_) std::copy(first.begin(), first.end(), lambda_.begin());
    std::vector<int> place(at(plan.rows), -1);
    for (int r = 0; r < plan.rows; ++r) {
      if (dropped[at(r)]) continue;
      place[at(r)] = static_cast<int>(row_.size());
      row_.push_back(r);
    }
    for (int c = 0; c < plan.columns; ++c) {
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
        const int kept = place[at(plan.jacobian.row_index[at(k)])];
        if (kept >= 0) entry_.push_back({kept, c, k});
      }
    }
  }
  // The larger side of the box that holds all bodies, at least the length scale.
  double scene_extent() const {
    constexpr double far = std::numeric_limits<double>::infinity();
    Vec2<double> low{far, far}, high{-far, -far};
    for (int b = 0; b < system_.plan().moving; ++b) {
      const Vec2<double> place = system_.evaluator().ground_frame(b).origin();
      low = {std::min(low.x, place.x), std::min(low.y, place.y)};
      high = {std::max(high.x, place.x), std::max(high.y, place.y)};
    }
    return std::max({system_.length(), high.x - low.x, high.y - low.y});
  }
  double unit(int column) const { return system_.plan().coordinate[at(column)] % 3 == 2 ? 1.0 : length_; }
  double row_unit(int kept) const { return system_.plan().row_is_angle[at(row_[at(kept)])] ? 1.0 : length_; }
  // Ipopt evaluates all functions at one place before it goes to the next.
  void move_to(const double* x) {
    if (std::equal(last_.begin(), last_.end(), x) && !last_.empty()) return;
    const Plan& plan = system_.plan();
    last_.assign(x, x + plan.columns);
    for (int c = 0; c < plan.columns; ++c) trial_[at(plan.coordinate[at(c)])] = x[c] * unit(c);
    system_.move_to(trial_);
  }

  StaticSystem& system_;
  StaticHessian hessian_;
  std::span<double> q_, lambda_;
  bool warm_;
  std::vector<double> start_, trial_, last_, row_multiplier_;
  std::vector<int> row_;  // of the plan
  std::vector<Entry> entry_;
  double energy_ = 1, length_ = 1;
  int iterations_ = 0;
};

StaticEnd ending(IpoptEnd end) {
  switch (end) {
    case IpoptEnd::solved:
    case IpoptEnd::acceptable:
      return StaticEnd::stationary;
    case IpoptEnd::diverging:
      return StaticEnd::unbounded;
    case IpoptEnd::slow:
      return StaticEnd::slow;
    case IpoptEnd::stopped:
      return StaticEnd::cancelled;
    case IpoptEnd::unavailable:
      return StaticEnd::singular;
    default:
      return StaticEnd::diverged;
  }
}

}  // namespace

bool ipopt_is_built_in() { return ipopt_program_is_built_in(); }

StaticOutcome solve_by_ipopt(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                             const StaticIpoptOptions& options) {
  if (!ipopt_is_built_in()) return {.end = StaticEnd::singular};
  system.move_to(q);
  const double load = system.force_norm(system.gradient());
  Problem problem(system, q, lambda, options.warm);
  StaticOutcome outcome;
  // In a long mechanism rounding of the forces may prevent the last digits: an acceptable end will do.
  outcome.end = ending(run_ipopt(problem, {.max_iterations = options.max_iterations,
                                           .tolerance = options.tolerance,
                                           .warm = options.warm,
                                           .verbose = options.verbose}));
  if (outcome.end == StaticEnd::singular) return outcome;
  outcome.iterations = problem.iterations();
  system.move_to(q);
  std::vector<double> residual(system.gradient().size());
  system.residual(lambda, residual);
  outcome.residual = system.force_norm(residual);
  // Springs that balance each other leave no net force: their forces at the start count as well.
  const double force = std::max(system.force_scale(lambda), load);
  const bool balanced = outcome.residual <= rough * force && system.phi_norm() <= rough;
  if (outcome.converged() && !balanced) outcome.end = StaticEnd::diverged;
  return outcome;
}

}  // namespace catena
