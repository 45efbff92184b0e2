#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "catena/analysis/design/design_search.hpp"

namespace catena {
namespace {

// A design with an optimality below this is stationary, whatever the method said of its end: gradients are good to
// 1e-8, and steps of the size of the tolerance leave its root.
constexpr double stationary = 1e-5;

/// Of the given start for number 0, random within the bounds for others.
std::vector<double> start_of(const DesignProblem& problem, std::mt19937_64& random, int number) {
  std::vector<double> u(problem.start.size());
  for (std::size_t v = 0; v < u.size(); ++v) {
    // The same numbers on every machine: 53 bits of the generator's own.
    const double any = static_cast<double>(random() >> 11) * 0x1.0p-53;
    u[v] = number > 0 ? any : (problem.start[v] - problem.lower[v]) / (problem.upper[v] - problem.lower[v]);
  }
  return u;
}

void require_sound(const DesignProblem& problem) {
  const std::size_t n = problem.start.size();
  if (n == 0 || problem.lower.size() != n || problem.upper.size() != n || !problem.evaluate)
    throw std::invalid_argument(
        "a design problem needs variables, each with bounds and a start, and a way to analyse it");
  for (std::size_t v = 0; v < n; ++v) {
    if (!(problem.lower[v] < problem.upper[v]) || !(problem.start[v] >= problem.lower[v]) ||
        !(problem.start[v] <= problem.upper[v]))
      throw std::invalid_argument("variable number " + std::to_string(v) +
                                  " of the design problem does not start within its bounds");
  }
}

}  // namespace

DesignOutcome optimise_design(const DesignProblem& problem, const DesignOptions& options) {
  require_sound(problem);
  DesignOutcome outcome;
  DesignSearch search(problem, options, outcome);
  std::mt19937_64 random(options.seed);
  bool analysed = false;
  MinimiserEnd end = MinimiserEnd::failed;  // of the start that led to the best design
  for (int k = 0; k < options.starts && (k == 0 || search.go_on()); ++k) {
    std::vector<double> u = start_of(problem, random, k);
    const int improvements = search.improvements();
    if (!search.begin(u)) continue;
    analysed = true;
    const MinimiserOptions wanted{.method = options.method,
                                  .lower = std::vector<double>(u.size(), 0.0),
                                  .upper = std::vector<double>(u.size(), 1.0),
                                  .x_tolerance = options.tolerance,
                                  .f_tolerance = 1e-3 * options.tolerance,
                                  .constraint_tolerance = options.tolerance,
                                  .max_evaluations = std::max(1, options.max_evaluations - outcome.evaluations),
                                  .seed = options.seed};
    const MinimiserEnd ended = minimise(search, wanted, u);
    if (search.improvements() > improvements) end = ended;
  }
  if (!analysed) {
    search.go_on();
    if (search.was_cancelled()) outcome.end = DesignEnd::cancelled;
    return outcome;
  }
  if (!search.was_cancelled() && search.complete_best()) {
    Stationarity found =
        optimality_of(problem, outcome.x, outcome.values, search.unequal_sizes(), search.gradient_size());
    outcome.optimality = found.optimality;
    outcome.active_unequal = std::move(found.active_unequal);
  }
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
  else if (converged || (feasible && outcome.optimality && *outcome.optimality <= stationary))
    outcome.end = feasible ? DesignEnd::converged : DesignEnd::infeasible;
  else
    outcome.end = end == MinimiserEnd::slow ? DesignEnd::slow : DesignEnd::broken_off;
  return outcome;
}

}  // namespace catena
