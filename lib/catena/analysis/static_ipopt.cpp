#include "catena/analysis/static_ipopt.hpp"

#if CATENA_HAS_IPOPT

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "catena/analysis/static_hessian.hpp"

namespace catena {
namespace {

using Ipopt::Index;
using Ipopt::Number;

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// Ipopt takes anything beyond 1e19 for no bound.
constexpr double no_bound = 2e19;
// Of the complementarity at a warm start.
constexpr double near_barrier = 1e-9;
// Forces of the first multipliers that are larger than this many loads say nothing about the solution.
constexpr double largest_force = 1e6;

std::mutex& only_one() {
  static std::mutex mutex;
  return mutex;
}

// The scaled problem as Ipopt asks for it. Vectors x over columns, g over the rows that are kept.
class Problem final : public Ipopt::TNLP {
 public:
  Problem(StaticSystem& system, std::span<double> q, std::span<double> lambda, bool warm)
      : system_(system), hessian_(system), q_(q), lambda_(lambda), warm_(warm) {
    const Plan& plan = system.plan();
    system.move_to(q);
    start_.resize(at(plan.columns));
    for (int c = 0; c < plan.columns; ++c) start_[at(c)] = q[at(plan.coordinate[at(c)])];
    trial_.assign(q.begin(), q.end());
    keep_independent_rows();
    // Multipliers of size one: MUMPS pivots on what the Hessian holds beside the Jacobian.
    const double load = std::max(system.load_size(), 1e-100);
    energy_ = std::min(system.force_scale(lambda), largest_force * load) * system.length();
    if (!(energy_ > 0)) energy_ = load * system.length();
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
  bool eval_f(Index, const Number* x, bool is_new, Number& f) override {
    move_to(x, is_new);
    f = system_.energy() / energy_;
    return std::isfinite(f);
  }
  bool eval_grad_f(Index n, const Number* x, bool is_new, Number* gradient) override {
    move_to(x, is_new);
    for (Index c = 0; c < n; ++c) gradient[c] = system_.gradient()[at(c)] * unit(c) / energy_;
    return true;
  }
  bool eval_g(Index, const Number* x, bool is_new, Index m, Number* g) override {
    move_to(x, is_new);
    double sum = 0;
    for (Index k = 0; k < m; ++k) {
      g[k] = system_.phi()[at(row_[at(k)])] / row_unit(k);
      sum += g[k];
    }
    return std::isfinite(sum);
  }
  bool eval_jac_g(Index, const Number* x, bool is_new, Index, Index entries, Index* rows, Index* columns,
                  Number* values) override {
    if (!values) {
      for (Index k = 0; k < entries; ++k) {
        rows[k] = entry_[at(k)].row;
        columns[k] = entry_[at(k)].column;
      }
      return true;
    }
    move_to(x, is_new);
    for (Index k = 0; k < entries; ++k) {
      const Entry& e = entry_[at(k)];
      values[k] = system_.jacobian()[at(e.slot)] * unit(e.column) / row_unit(e.row);
    }
    return true;
  }
  bool eval_h(Index, const Number* x, bool is_new, Number factor, Index m, const Number* lambda, bool, Index entries,
              Index* rows, Index* columns, Number* values) override {
    if (!values) {
      for (Index k = 0; k < entries; ++k) {
        rows[k] = hessian_.row[at(k)];
        columns[k] = hessian_.column[at(k)];
      }
      return true;
    }
    move_to(x, is_new);
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
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number*, const Number*, Index m,
                         const Number*, const Number* lambda, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    move_to(x, true);
    std::copy(trial_.begin(), trial_.end(), q_.begin());
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
    for (Index k = 0; k < m; ++k) lambda_[at(row_[at(k)])] = lambda[k] * energy_ / row_unit(k);
  }

 private:
  struct Entry {
    int row, column, slot;
  };

  // Equalities that follow from others at the start are dropped; without a factorization there all rows stay.
  void keep_independent_rows() {
    const Plan& plan = system_.plan();
    std::vector<char> dropped(at(plan.rows), 0);
    std::vector<double> first(lambda_.size());
    if (first_multipliers(system_, first)) {
      for (int r : system_.matrix().dependent_rows()) dropped[at(r)] = system_.side(r) == RowSide::both;
      if (!warm_) std::copy(first.begin(), first.end(), lambda_.begin());
    }
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
  double unit(int column) const { return system_.plan().coordinate[at(column)] % 3 == 2 ? 1.0 : system_.length(); }
  double row_unit(int kept) const { return system_.plan().row_is_angle[at(row_[at(kept)])] ? 1.0 : system_.length(); }
  void move_to(const Number* x, bool is_new) {
    if (!is_new && moved_) return;
    const Plan& plan = system_.plan();
    for (int c = 0; c < plan.columns; ++c) trial_[at(plan.coordinate[at(c)])] = x[c] * unit(c);
    system_.move_to(trial_);
    moved_ = true;
  }

  StaticSystem& system_;
  StaticHessian hessian_;
  std::span<double> q_, lambda_;
  bool warm_, moved_ = false;
  std::vector<double> start_, trial_, row_multiplier_;
  std::vector<int> row_;  // of the plan
  std::vector<Entry> entry_;
  double energy_ = 1;
  int iterations_ = 0;
};

StaticEnd ending(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return StaticEnd::stationary;
    case Ipopt::Diverging_Iterates:
      return StaticEnd::unbounded;
    case Ipopt::Maximum_Iterations_Exceeded:
      return StaticEnd::slow;
    default:
      return StaticEnd::diverged;
  }
}

}  // namespace

bool ipopt_is_built_in() { return true; }

StaticOutcome solve_by_ipopt(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                             const StaticIpoptOptions& options) {
  const std::lock_guard lock(only_one());
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
  // Beside forces in a long mechanism rounding may keep the last digits out of reach.
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
