#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "catena/analysis/design/design_starts.hpp"

namespace catena {
namespace {

// A design with an optimality below this is stationary, whatever the method said of its end: gradients are good to
// 1e-8, and steps of the size of the tolerance leave its root.
constexpr double stationary = 1e-5;
// A method ends where its steps, or what they gain, fall below its tolerances: a gain of 1e-3 of the tolerance leaves a
// gradient of its root. A design with an optimality below this many of these is what the method calls done.
constexpr double roots_of_gain = 30;
// Steps that tell a design that is not stationary from one at a kink, in parts of the ranges: downhill the objective
// falls by this part at least of what the gradient promises.
constexpr double short_steps[] = {1e-3, 1e-5};
constexpr double kept_promise = 0.1;
// A design that is nearer to the bottom of its parabola is there: half the digits of a double.
constexpr double rounding_of_place = 1e-8;
// How far the design is from which one sees whether variables change the objective at all, in parts of their ranges.
constexpr double beside = 0.25;
// How often a method that ends where it could go downhill is begun anew from there.
constexpr int most_renewals = 2;

void require_sound(const DesignProblem& problem) {
  const std::size_t n = problem.start.size();
  if (n == 0 || problem.lower.size() != n || problem.upper.size() != n || !(problem.evaluate || problem.begin_search))
    throw std::invalid_argument(
        "a design problem needs variables, each with bounds and a start, and a way to analyse it");
  for (std::size_t v = 0; v < n; ++v) {
    if (!(problem.lower[v] < problem.upper[v]) || !(problem.start[v] >= problem.lower[v]) ||
        !(problem.start[v] <= problem.upper[v]))
      throw std::invalid_argument("variable number " + std::to_string(v) +
                                  " of the design problem does not start within its bounds");
  }
}

/// The best design's distance from a stationary one, as far as gradients there tell it.
std::vector<double> measure(const DesignProblem& problem, DesignSearch& search, DesignOutcome& outcome) {
  outcome.optimality.reset();
  outcome.active_unequal.clear();
  if (search.was_cancelled() || !search.complete_best()) return {};
  Stationarity found =
      optimality_of(problem, outcome.x, outcome.values, search.unequal_sizes(), search.gradient_size());
  outcome.optimality = found.optimality;
  outcome.active_unequal = std::move(found.active_unequal);
  return std::move(found.rest);
}

/// Whether the best design is a stationary one, whatever the method says of it; true where a short step leads to a
/// better one, to which the outcome then moves.
bool goes_downhill(const DesignProblem& problem, const DesignOptions& options, DesignSearch& search,
                   DesignOutcome& outcome) {
  outcome.at_kink = false;
  const std::vector<double> rest = measure(problem, search, outcome);
  const double good_enough = std::max(stationary, roots_of_gain * std::sqrt(part_of_gain * options.tolerance));
  const double allowed = 10 * options.tolerance;
  if (!outcome.optimality || *outcome.optimality <= good_enough || outcome.violation > allowed) return false;
  double slope = 0;
  for (const double r : rest) slope += r * r;
  slope = std::sqrt(slope);
  for (const double step : short_steps) {
    std::vector<double> direction(rest);
    for (double& d : direction) d *= -step / slope;
    // Along curved constraints a step misses them by its square.
    const std::optional<double> change = search.change_along(direction, std::max(allowed, 10 * step * step));
    if (!change) continue;
    if (*change < -kept_promise * slope * step) {
      measure(problem, search, outcome);
      return true;
    }
    // The bottom of the parabola through it, where the objective is one.
    const double bend = 2 * (*change + slope * step) / (step * step), distance = slope / bend;
    if (distance <= std::max(allowed, rounding_of_place)) {
      outcome.optimality = std::min(*outcome.optimality, distance);
      return false;
    }
  }
  outcome.at_kink = true;
  return false;
}

/// The largest violation t of the constraints, to be least: all of them at most t, in their sizes.
class LeastViolation final : public MinimisationProblem {
 public:
  explicit LeastViolation(DesignSearch& search) : search_(search), n_(static_cast<std::size_t>(search.variables())) {
    equal_.resize(static_cast<std::size_t>(search.equations()));
    by_unequal_.resize(static_cast<std::size_t>(search.inequalities()) * n_);
    by_equal_.resize(equal_.size() * n_);
  }
  int variables() const override { return static_cast<int>(n_) + 1; }
  int inequalities() const override { return search_.inequalities() + 2 * search_.equations(); }
  int equations() const override { return 0; }
  double objective(std::span<const double> x, std::span<double> gradient) override {
    std::fill(gradient.begin(), gradient.end(), 0.0);
    if (!gradient.empty()) gradient[n_] = 1;
    return x[n_];
  }
  void unequal(std::span<const double> x, std::span<double> g, std::span<double> jacobian) override {
    const auto u = x.first(n_);
    const auto rows = static_cast<std::size_t>(search_.inequalities());
    const bool slopes = !jacobian.empty();
    if (rows > 0) search_.unequal(u, g.first(rows), slopes ? std::span<double>(by_unequal_) : std::span<double>());
    if (!equal_.empty()) search_.equal(u, equal_, slopes ? std::span<double>(by_equal_) : std::span<double>());
    for (std::size_t k = 0; k < g.size(); ++k) {
      const std::size_t e = (k - rows) / 2;
      const double sign = k < rows || (k - rows) % 2 == 0 ? 1 : -1;
      const std::vector<double>& by = k < rows ? by_unequal_ : by_equal_;
      if (k >= rows) g[k] = sign * equal_[e];
      g[k] -= x[n_];
      for (std::size_t v = 0; v < n_ && slopes; ++v)
        jacobian[k * (n_ + 1) + v] = sign * by[(k < rows ? k : e) * n_ + v];
      if (slopes) jacobian[k * (n_ + 1) + n_] = -1;
    }
  }
  void equal(std::span<const double>, std::span<double>, std::span<double>) override {}
  bool go_on() override { return search_.go_on(); }

 private:
  DesignSearch& search_;
  std::size_t n_;
  std::vector<double> equal_, by_unequal_, by_equal_;
};

/// Looks for the design that misses the constraints least; the best one is it then, and may meet them after all.
MinimiserEnd lessen_violation(const DesignOptions& options, DesignSearch& search, const DesignOutcome& outcome) {
  LeastViolation problem(search);
  std::vector<double> x = search.best();
  x.push_back(outcome.violation);
  MinimiserOptions wanted = minimiser_options(options, outcome.evaluations, x.size());
  const bool slsqp = minimiser_is_built_in(MinimiserMethod::slsqp);
  wanted.method = !uses_gradients(options.method) ? MinimiserMethod::cobyla
                  : slsqp                         ? MinimiserMethod::slsqp
                                                  : MinimiserMethod::ipopt;
  wanted.upper.back() = 2 * outcome.violation + 1;
  return minimise(problem, wanted, x);
}

/// What goes on from the best design: the method itself, or after a search everywhere one that stays near it.
MinimiserOptions near_options(const DesignOptions& options, const DesignSearch& search, const DesignOutcome& outcome) {
  const auto variables = static_cast<std::size_t>(search.variables());
  MinimiserOptions wanted = minimiser_options(options, outcome.evaluations, variables);
  if (!searches_everywhere(options.method)) return wanted;
  // A parabola takes two variables or more, and knows bounds alone.
  const bool bounds_alone = search.inequalities() + search.equations() == 0 && variables > 1;
  wanted.method = bounds_alone ? MinimiserMethod::bobyqa : MinimiserMethod::cobyla;
  return wanted;
}

/// How a search ended, and whether a step downhill leads on from its best design.
struct Ended {
  MinimiserEnd end;
  bool downhill;
};

/// A start without slope may be an optimum, or nothing depends on the variables: a design aside of it tells. Where that
/// one is better the search goes on from there.
void look_aside(const DesignProblem& problem, const DesignOptions& options, DesignSearch& search,
                DesignOutcome& outcome, Ended& ended) {
  std::vector<double> aside = search.best();
  for (double& u : aside) u = u < 0.5 ? beside : -beside;
  const int before = search.improvements();
  outcome.is_constant = search.change_along(aside, std::numeric_limits<double>::infinity()) == 0.0;
  if (search.improvements() == before) return;
  if (std::vector<double> u = search.best(); search.begin(u))
    ended.end = minimise(search, near_options(options, search, outcome), u);
  ended.downhill = goes_downhill(problem, options, search, outcome);
}

/// A search everywhere knows no end but that of its designs: the best of them is the start of a search without
/// gradients that has one. How that ended.
MinimiserEnd search_near_best(const DesignOptions& options, DesignSearch& search, const DesignOutcome& outcome,
                              MinimiserEnd end) {
  search.stay_near();
  std::vector<double> u = search.best();
  if (!search.go_on() || !search.begin(u)) return end;
  return minimise(search, near_options(options, search, outcome), u);
}

}  // namespace

DesignOutcome optimise_design(const DesignProblem& problem, const DesignOptions& options) {
  require_sound(problem);
  DesignOutcome outcome;
  DesignSearch search(problem, options, outcome);
  std::optional<MinimiserEnd> found = search_from_all_starts(problem, options, search, outcome);
  if (!found) {
    search.go_on();
    if (search.was_cancelled()) outcome.end = DesignEnd::cancelled;
    return outcome;
  }
  if (searches_everywhere(options.method)) found = search_near_best(options, search, outcome, *found);
  Ended ended{*found, goes_downhill(problem, options, search, outcome)};
  auto& [end, downhill] = ended;
  for (int n = 0; downhill && end == MinimiserEnd::converged && n < most_renewals && search.go_on(); ++n) {
    std::vector<double> u = search.best();
    if (!search.begin(u)) break;
    end = minimise(search, near_options(options, search, outcome), u);
    downhill = goes_downhill(problem, options, search, outcome);
  }
  if (outcome.violation > 10 * options.tolerance && search.go_on()) {
    const MinimiserEnd least = lessen_violation(options, search, outcome);
    if (outcome.violation > 10 * options.tolerance) {
      if (least == MinimiserEnd::converged || least == MinimiserEnd::rounding) end = MinimiserEnd::converged;
      measure(problem, search, outcome);
    } else if (std::vector<double> u = search.best(); search.begin(u)) {
      end = minimise(search, near_options(options, search, outcome), u);
      downhill = goes_downhill(problem, options, search, outcome);
    }
  }
  if (search.gradient_size() == 0 && search.go_on()) look_aside(problem, options, search, outcome, ended);
  for (std::size_t v = 0; v < outcome.x.size(); ++v) {
    if (outcome.x[v] == problem.lower[v]) outcome.at_lower.push_back(static_cast<int>(v));
    if (outcome.x[v] == problem.upper[v]) outcome.at_upper.push_back(static_cast<int>(v));
  }
  const bool feasible = outcome.violation <= 10 * options.tolerance;
  // A method that comes no further for rounding may be at an optimum, or unable to solve its own equations.
  const bool rounded = end == MinimiserEnd::rounding && (!feasible || !outcome.optimality);
  const bool converged = end == MinimiserEnd::converged || rounded;
  if (search.was_cancelled())
    outcome.end = DesignEnd::cancelled;
  else if (converged && feasible && downhill)
    outcome.end = DesignEnd::not_stationary;
  else if (converged || (feasible && outcome.optimality && *outcome.optimality <= stationary))
    outcome.end = feasible ? DesignEnd::converged : DesignEnd::infeasible;
  else
    // Stopped without being cancelled: it ran out of designs.
    outcome.end = end == MinimiserEnd::slow || end == MinimiserEnd::stopped ? DesignEnd::slow : DesignEnd::broken_off;
  return outcome;
}

}  // namespace catena
