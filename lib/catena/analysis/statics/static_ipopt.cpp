#include "catena/analysis/statics/static_ipopt.hpp"

#if CATENA_HAS_IPOPT

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

#include "catena/analysis/balance/static_hessian.hpp"
#include "catena/analysis/minimiser/ipopt_turn.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using Ipopt::Index;
using Ipopt::Number;

// Ipopt takes any value beyond 1e19 as no bound.
constexpr double no_bound = 2e19;
// Of the complementarity at a warm start.
constexpr double near_barrier = 1e-9;
// Of a start at a singular position: length scales or rad.
constexpr double smallest_disturbance = 1e-3;
// Solutions of Ipopt must balance to this part of the forces, and meet the constraints to it.
constexpr double rough = 1e-5;

// The scaled problem in Ipopt's interface. Vectors x over columns, g over the equations that are kept.
class Problem final : public Ipopt::TNLP {
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

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(start_.size());
    m = static_cast<Index>(row_.size());
    jacobian = static_cast<Index>(entry_.size());
    hessian = static_cast<Index>(hessian_.slot.size());
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* x_low, Number* x_high, Index m, Number* g_low, Number* g_high) override {
    std::fill(x_low, x_low + n, -no_bound);
    std::fill(x_high, x_high + n, no_bound);
    for (Index k = 0; k < m; ++k) {
      const RowSide side = system_.side(row_[at(k)]);
      g_low[k] = side == RowSide::at_most ? -no_bound : 0;
      g_high[k] = side == RowSide::at_least ? no_bound : 0;
    }
    return true;
  }
  bool get_starting_point(Index n, bool, Number* x, bool bounds, Number* low, Number* high, Index m, bool multipliers,
                          Number* lambda) override {
    for (Index c = 0; c < n; ++c) x[c] = start_[at(c)] / unit(c);
    if (bounds) {
      std::fill(low, low + n, 0.0);
      std::fill(high, high + n, 0.0);
    }
    if (multipliers) {
      for (Index k = 0; k < m; ++k) lambda[k] = lambda_[at(row_[at(k)])] * row_unit(k) / energy_;
    }
    return true;
  }
  bool eval_f(Index, const Number* x, bool, Number& f) override {
    move_to(x);
    f = system_.energy() / energy_;
    return std::isfinite(f);
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    move_to(x);
    for (Index c = 0; c < n; ++c) gradient[c] = system_.gradient()[at(c)] * unit(c) / energy_;
    return true;
  }
  bool eval_g(Index, const Number* x, bool, Index m, Number* g) override {
    move_to(x);
    double sum = 0;
    for (Index k = 0; k < m; ++k) {
      g[k] = system_.phi()[at(row_[at(k)])] / row_unit(k);
      sum += g[k];
    }
    return std::isfinite(sum);
  }
  bool eval_jac_g(Index, const Number* x, bool, Index, Index entries, Index* rows, Index* columns,
                  Number* values) override {
    if (!values) {
      for (Index k = 0; k < entries; ++k) {
        rows[k] = entry_[at(k)].row;
        columns[k] = entry_[at(k)].column;
      }
      return true;
    }
    move_to(x);
    for (Index k = 0; k < entries; ++k) {
      const Entry& e = entry_[at(k)];
      values[k] = system_.jacobian()[at(e.slot)] * unit(e.column) / row_unit(e.row);
    }
    return true;
  }
  bool eval_h(Index, const Number* x, bool, Number factor, Index m, const Number* lambda, bool, Index entries,
              Index* rows, Index* columns, Number* values) override {
    if (!values) {
      for (Index k = 0; k < entries; ++k) {
        rows[k] = hessian_.row[at(k)];
        columns[k] = hessian_.column[at(k)];
      }
      return true;
    }
    move_to(x);
    for (Index k = 0; k < m; ++k) row_multiplier_[at(row_[at(k)])] = lambda[k] * energy_ / row_unit(k);
    hessian_.evaluate(factor, row_multiplier_);
    for (Index k = 0; k < entries; ++k) {
      values[k] = hessian_.value[at(k)] * unit(hessian_.row[at(k)]) * unit(hessian_.column[at(k)]) / energy_;
    }
    return true;
  }
  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number, Number, Number, Number,
                             Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    iterations_ = iteration;
    ++system_.evaluator().counters.iterations;
    return !system_.is_cancelled();
  }
  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number*, const Number*, Index m,
                         const Number*, const Number* lambda, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    move_to(x);
    std::copy(trial_.begin(), trial_.end(), q_.begin());
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
    for (Index k = 0; k < m; ++k) lambda_[at(row_[at(k)])] = lambda[k] * energy_ / row_unit(k);
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
  void move_to(const Number* x) {
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

StaticEnd ending(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
      return StaticEnd::stationary;
    case Ipopt::Diverging_Iterates:
      return StaticEnd::unbounded;
    case Ipopt::Maximum_Iterations_Exceeded:
      return StaticEnd::slow;
    case Ipopt::User_Requested_Stop:
      return StaticEnd::cancelled;
    default:
      return StaticEnd::diverged;
  }
}

}  // namespace

bool ipopt_is_built_in() { return true; }

StaticOutcome solve_by_ipopt(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                             const StaticIpoptOptions& options) {
  const std::lock_guard lock(ipopt_turn());
  system.move_to(q);
  const double load = system.force_norm(system.gradient());
  const Ipopt::SmartPtr<Problem> problem = new Problem(system, q, lambda, options.warm);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  if (options.verbose) application->Jnlst()->AddFileJournal("log", "stderr", Ipopt::J_ITERSUMMARY);
  Ipopt::OptionsList& set = *application->Options();
  set.SetStringValue("sb", "yes");
  set.SetStringValue("nlp_scaling_method", "none");
  set.SetStringValue("linear_solver", "mumps");
  set.SetStringValue("fixed_variable_treatment", "make_parameter");
  set.SetIntegerValue("max_iter", options.max_iterations);
  set.SetNumericValue("tol", options.tolerance);
  // In a long mechanism rounding of the forces may prevent the last digits.
  set.SetNumericValue("acceptable_tol", 1e4 * options.tolerance);
  set.SetIntegerValue("acceptable_iter", 8);
  if (options.warm) {
    set.SetStringValue("warm_start_init_point", "yes");
    set.SetNumericValue("mu_init", near_barrier);
    set.SetNumericValue("warm_start_bound_push", near_barrier);
    set.SetNumericValue("warm_start_slack_bound_push", near_barrier);
    set.SetNumericValue("warm_start_mult_bound_push", near_barrier);
  }
  StaticOutcome outcome;
  if (application->Initialize() != Ipopt::Solve_Succeeded) {
    outcome.end = StaticEnd::singular;
    return outcome;
  }
  outcome.end = ending(application->OptimizeTNLP(problem));
  outcome.iterations = problem->iterations();
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

#else

namespace catena {

bool ipopt_is_built_in() { return false; }

StaticOutcome solve_by_ipopt(StaticSystem&, std::span<double>, std::span<double>, const StaticIpoptOptions&) {
  return {.end = StaticEnd::singular};
}

}  // namespace catena

#endif
