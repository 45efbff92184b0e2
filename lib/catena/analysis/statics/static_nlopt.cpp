#include "catena/analysis/statics/static_nlopt.hpp"

#if CATENA_HAS_NLOPT

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// An energy this far below the start, in units of force times length, has no bottom.
constexpr double bottomless = 1e9;

class Problem {
 public:
  Problem(StaticSystem& system, std::span<const double> q) : system_(system), trial_(q.begin(), q.end()) {
    const Plan& plan = system.plan();
    system.move_to(q);
    energy_ = std::max(system.load_size(), 1e-100) * system.length();
    for (int c = 0; c < plan.columns; ++c) {
      unit_.push_back(plan.coordinate[at(c)] % 3 == 2 ? 1.0 : system.length());
      x.push_back(q[at(plan.coordinate[at(c)])] / unit_.back());
    }
    std::vector<double> multipliers(at(plan.rows));
    std::vector<char> dropped(at(plan.rows), 0);
    if (first_multipliers(system, multipliers)) {
      for (int r : system.matrix().dependent_rows()) dropped[at(r)] = system.side(r) == RowSide::both;
    }
    for (int r = 0; r < plan.rows; ++r) {
      if (!dropped[at(r)]) (system.side(r) == RowSide::both ? equations : inequalities).push_back(r);
    }
  }

  std::vector<double> x;                     // scaled coordinates
  std::vector<int> equations, inequalities;  // rows of the plan

  const std::vector<double>& configuration(const double* scaled) {
    for (std::size_t c = 0; c < unit_.size(); ++c) trial_[at(system_.plan().coordinate[c])] = scaled[c] * unit_[c];
    return trial_;
  }

  static double objective(unsigned n, const double* scaled, double* gradient, void* self) {
    Problem& p = *static_cast<Problem*>(self);
    p.system_.move_to(p.configuration(scaled));
    p.system_.evaluator().counters.iterations += 1;
    ++p.evaluations;
    if (p.optimiser && p.system_.is_cancelled()) nlopt_force_stop(p.optimiser);
    for (unsigned c = 0; gradient && c < n; ++c) gradient[c] = p.system_.gradient()[c] * p.unit_[c] / p.energy_;
    return p.system_.energy() / p.energy_;
  }
  static void equal(unsigned m, double* result, unsigned n, const double* scaled, double* gradient, void* self) {
    Problem& p = *static_cast<Problem*>(self);
    p.rows_at(p.equations, m, result, n, scaled, gradient);
  }
  // NLopt wants g <= 0.
  static void unequal(unsigned m, double* result, unsigned n, const double* scaled, double* gradient, void* self) {
    Problem& p = *static_cast<Problem*>(self);
    p.rows_at(p.inequalities, m, result, n, scaled, gradient);
    for (unsigned k = 0; k < m; ++k) {
      if (p.system_.side(p.inequalities[k]) == RowSide::at_most) continue;
      result[k] = -result[k];
      for (unsigned c = 0; gradient && c < n; ++c) gradient[k * n + c] = -gradient[k * n + c];
    }
  }

  int evaluations = 0;
  nlopt_opt optimiser = nullptr;  // to be stopped where the user cancels

 private:
  void rows_at(const std::vector<int>& rows, unsigned m, double* result, unsigned n, const double* scaled,
               double* gradient) {
    const Plan& plan = system_.plan();
    system_.move_to(configuration(scaled));
    std::vector<int> place(at(plan.rows), -1);
    for (unsigned k = 0; k < m; ++k) {
      place[at(rows[k])] = static_cast<int>(k);
      result[k] = system_.phi()[at(rows[k])] / row_unit(rows[k]);
    }
    if (!gradient) return;
    std::fill(gradient, gradient + std::size_t{m} * n, 0.0);
    for (int c = 0; c < plan.columns; ++c) {
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
        const int row = plan.jacobian.row_index[at(k)], kept = place[at(row)];
        if (kept >= 0) gradient[at(kept) * n + at(c)] += system_.jacobian()[at(k)] * unit_[at(c)] / row_unit(row);
      }
    }
  }
  double row_unit(int row) const { return system_.plan().row_is_angle[at(row)] ? 1.0 : system_.length(); }

  StaticSystem& system_;
  std::vector<double> trial_, unit_;
  double energy_ = 1;
};

StaticEnd ending(nlopt_result result) {
  switch (result) {
    case NLOPT_STOPVAL_REACHED:
      return StaticEnd::unbounded;
    case NLOPT_MAXEVAL_REACHED:
      return StaticEnd::slow;
    case NLOPT_FORCED_STOP:
      return StaticEnd::cancelled;
    // Where rounding ends the progress, the point is as good as it gets.
    case NLOPT_ROUNDOFF_LIMITED:
      return StaticEnd::stationary;
    default:
      return result > 0 ? StaticEnd::stationary : StaticEnd::diverged;
  }
}

}  // namespace

bool nlopt_is_built_in() { return true; }

StaticOutcome solve_by_nlopt(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                             const StaticNloptOptions& options) {
  Problem problem(system, q);
  const auto n = static_cast<unsigned>(problem.x.size());
  StaticOutcome outcome;
  if (n == 0) {
    outcome.end = StaticEnd::stationary;
    return outcome;
  }
  struct Destroy {
    void operator()(nlopt_opt_s* o) const { nlopt_destroy(o); }
  };
  const std::unique_ptr<nlopt_opt_s, Destroy> optimiser(
      nlopt_create(options.derivatives ? NLOPT_LD_SLSQP : NLOPT_LN_COBYLA, n));
  nlopt_opt o = optimiser.get();
  problem.optimiser = o;
  nlopt_set_min_objective(o, &Problem::objective, &problem);
  const std::vector<double> close(std::max(problem.equations.size(), problem.inequalities.size()), options.tolerance);
  if (!problem.equations.empty()) {
    nlopt_add_equality_mconstraint(o, static_cast<unsigned>(problem.equations.size()), &Problem::equal, &problem,
                                   close.data());
  }
  if (!problem.inequalities.empty()) {
    nlopt_add_inequality_mconstraint(o, static_cast<unsigned>(problem.inequalities.size()), &Problem::unequal, &problem,
                                     close.data());
  }
  const std::vector<double> small(n, options.tolerance);
  nlopt_set_xtol_abs(o, small.data());
  nlopt_set_maxeval(o, options.max_evaluations);
  double energy = Problem::objective(n, problem.x.data(), nullptr, &problem);
  nlopt_set_stopval(o, energy - bottomless);
  outcome.end = ending(nlopt_optimize(o, problem.x.data(), &energy));
  outcome.iterations = problem.evaluations;
  const std::vector<double>& found = problem.configuration(problem.x.data());
  std::copy(found.begin(), found.end(), q.begin());
  system.move_to(q);
  if (outcome.converged() && !first_multipliers(system, lambda)) outcome.end = StaticEnd::singular;
  std::vector<double> residual(system.gradient().size());
  system.residual(lambda, residual);
  outcome.residual = system.force_norm(residual);
  return outcome;
}

}  // namespace catena

#else

namespace catena {

bool nlopt_is_built_in() { return false; }

StaticOutcome solve_by_nlopt(StaticSystem&, std::span<double>, std::span<double>, const StaticNloptOptions&) {
  return {.end = StaticEnd::singular};
}

}  // namespace catena

#endif
