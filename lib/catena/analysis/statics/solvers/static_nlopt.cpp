#include "catena/analysis/statics/solvers/static_nlopt.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// An energy this far below the start, in units of force times length, has no bottom.
constexpr double bottomless = 1e9;

class Problem final : public MinimisationProblem {
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
      if (!dropped[at(r)]) (system.side(r) == RowSide::both ? equations_ : inequalities_).push_back(r);
    }
  }

  std::vector<double> x;  // scaled coordinates
  int evaluations = 0;

  const std::vector<double>& configuration(std::span<const double> scaled) {
    for (std::size_t c = 0; c < unit_.size(); ++c) trial_[at(system_.plan().coordinate[c])] = scaled[c] * unit_[c];
    return trial_;
  }

  int variables() const override { return static_cast<int>(x.size()); }
  int inequalities() const override { return static_cast<int>(inequalities_.size()); }
  int equations() const override { return static_cast<int>(equations_.size()); }
  double objective(std::span<const double> scaled, std::span<double> gradient) override {
    system_.move_to(configuration(scaled));
    system_.evaluator().counters.iterations += 1;
    ++evaluations;
    for (std::size_t c = 0; c < gradient.size(); ++c) gradient[c] = system_.gradient()[c] * unit_[c] / energy_;
    return system_.energy() / energy_;
  }
  void equal(std::span<const double> scaled, std::span<double> h, std::span<double> jacobian) override {
    rows_at(equations_, scaled, h, jacobian);
  }
  // What is to be g <= 0.
  void unequal(std::span<const double> scaled, std::span<double> g, std::span<double> jacobian) override {
    rows_at(inequalities_, scaled, g, jacobian);
    for (std::size_t k = 0; k < g.size(); ++k) {
      if (system_.side(inequalities_[k]) == RowSide::at_most) continue;
      g[k] = -g[k];
      for (std::size_t c = 0; !jacobian.empty() && c < scaled.size(); ++c)
        jacobian[k * scaled.size() + c] = -jacobian[k * scaled.size() + c];
    }
  }
  bool go_on() override { return !system_.is_cancelled(); }

 private:
  void rows_at(const std::vector<int>& rows, std::span<const double> scaled, std::span<double> result,
               std::span<double> gradient) {
    const Plan& plan = system_.plan();
    system_.move_to(configuration(scaled));
    std::vector<int> place(at(plan.rows), -1);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      place[at(rows[k])] = static_cast<int>(k);
      result[k] = system_.phi()[at(rows[k])] / row_unit(rows[k]);
    }
    if (gradient.empty()) return;
    std::fill(gradient.begin(), gradient.end(), 0.0);
    for (int c = 0; c < plan.columns; ++c) {
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
        const int row = plan.jacobian.row_index[at(k)], kept = place[at(row)];
        if (kept >= 0)
          gradient[at(kept) * scaled.size() + at(c)] += system_.jacobian()[at(k)] * unit_[at(c)] / row_unit(row);
      }
    }
  }
  double row_unit(int row) const { return system_.plan().row_is_angle[at(row)] ? 1.0 : system_.length(); }

  StaticSystem& system_;
  std::vector<int> equations_, inequalities_;  // rows of the plan
  std::vector<double> trial_, unit_;
  double energy_ = 1;
};

StaticEnd ending(MinimiserEnd end) {
  switch (end) {
    case MinimiserEnd::enough:
      return StaticEnd::unbounded;
    case MinimiserEnd::slow:
      return StaticEnd::slow;
    case MinimiserEnd::stopped:
      return StaticEnd::cancelled;
    // Where rounding ends the progress, the point is as good as it gets.
    case MinimiserEnd::rounding:
    case MinimiserEnd::converged:
      return StaticEnd::stationary;
    case MinimiserEnd::failed:
      break;
  }
  return StaticEnd::diverged;
}

}  // namespace

StaticOutcome solve_by_nlopt(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                             const StaticNloptOptions& options) {
  StaticOutcome outcome;
  if (!nlopt_is_built_in()) {
    outcome.end = StaticEnd::singular;
    return outcome;
  }
  Problem problem(system, q);
  if (problem.x.empty()) {
    outcome.end = StaticEnd::stationary;
    return outcome;
  }
  MinimiserOptions wanted{.method = options.derivatives ? MinimiserMethod::slsqp : MinimiserMethod::cobyla,
                          .x_tolerance = options.tolerance,
                          .constraint_tolerance = options.tolerance,
                          .max_evaluations = options.max_evaluations};
  wanted.enough = problem.objective(problem.x, {}) - bottomless;
  outcome.end = ending(minimise(problem, wanted, problem.x));
  outcome.iterations = problem.evaluations;
  const std::vector<double>& found = problem.configuration(problem.x);
  std::copy(found.begin(), found.end(), q.begin());
  system.move_to(q);
  if (outcome.converged() && !first_multipliers(system, lambda)) outcome.end = StaticEnd::singular;
  std::vector<double> residual(system.gradient().size());
  system.residual(lambda, residual);
  outcome.residual = system.force_norm(residual);
  return outcome;
}

}  // namespace catena
