#include "catena/analysis/statics/solvers/static_active_set.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/statics/solvers/static_gaps.hpp"
#include "catena/base/at.hpp"

namespace catena {

double typical_force(StaticSystem& system) {
  if (system.dead_load() > 0) return system.dead_load();
  const double stiffest = 1e-3 * system.matrix().largest_stiffness() * system.length();
  return stiffest > 0 ? stiffest : 1;
}

std::vector<double> gap_values(StaticSystem& system) {
  std::vector<double> values;
  system.all_gaps(values);
  return values;
}

std::vector<char> strong_of(const ActiveSet& set) {
  std::vector<char> strong = set.closed;
  for (std::size_t k = 0; k < strong.size(); ++k) strong[k] = strong[k] && !set.weak[k];
  return strong;
}

std::vector<double> gap_faults(StaticSystem& system, std::span<const double> lambda, std::span<const char> closed) {
  const double force = std::max(system.force_scale(lambda), typical_force(system));
  std::vector<double> fault = gap_values(system);
  for (std::size_t k = 0; k < fault.size(); ++k) {
    const int row = system.plan().gap_rows[k];
    const GapUnits u = units_of(system, row, {system.length(), force});
    fault[k] = closed[k] ? lambda[at(row)] / u.force : -fault[k] / u.gap;
  }
  return fault;
}

void mark_weak(StaticSystem& system, std::span<const double> lambda, ActiveSet& set) {
  const double force = std::max(system.force_scale(lambda), typical_force(system));
  const std::vector<double> gap = gap_values(system);
  set.weak.assign(gap.size(), 0);
  for (std::size_t k = 0; k < gap.size(); ++k) {
    const GapUnits u = units_of(system, system.plan().gap_rows[k], {system.length(), force});
    const double p = -lambda[at(system.plan().gap_rows[k])];
    set.weak[k] = set.closed[k] ? p <= thresholds::no_force * u.force : gap[k] <= thresholds::closed_gap * u.gap;
  }
}

StaticOutcome finish_with_gaps(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                               const StaticGapOptions& options) {
  StaticOutcome outcome;
  const Plan& plan = system.plan();
  const std::size_t gaps = plan.gap_rows.size();
  const double scale = std::max(system.force_scale(lambda), typical_force(system));
  const std::vector<double> first = gap_values(system);
  set.closed.resize(gaps);
  for (std::size_t k = 0; k < gaps; ++k) {
    const GapUnits u = units_of(system, plan.gap_rows[k], {system.length(), scale});
    set.closed[k] = -lambda[at(plan.gap_rows[k])] / u.force > first[k] / u.gap;
  }
  std::set<std::vector<char>> tried;
  int iterations = 0;
  for (set.changes = 0; set.changes < most_sets; ++set.changes) {
    for (std::size_t k = 0; k < gaps; ++k) {
      if (!set.closed[k]) lambda[at(plan.gap_rows[k])] = 0;
    }
    system.close_gaps(set.closed);
    outcome = solve_by_newton(system, q, lambda,
                              {.max_iterations = 25, .tolerance = force_rounding, .warm = true, .stationary = true});
    iterations += outcome.iterations;
    outcome.iterations = iterations;
    if (!outcome.converged()) return outcome;
    if (system.is_cancelled()) {
      outcome.end = StaticEnd::cancelled;
      return outcome;
    }
    const std::vector<double> fault = gap_faults(system, lambda, set.closed);
    const double enough = std::max(options.tolerance, 100 * system.rounding_change());
    std::size_t worst = 0;
    for (std::size_t k = 0; k < gaps; ++k) worst = fault[k] > fault[worst] ? k : worst;
    if (gaps == 0 || !(fault[worst] > enough)) break;
    const bool one_by_one = !tried.insert(set.closed).second || set.changes >= most_sets_at_once;
    for (std::size_t k = 0; k < gaps; ++k) {
      if (one_by_one ? k == worst : fault[k] > enough) set.closed[k] = !set.closed[k];
    }
    outcome.end = StaticEnd::slow;
  }
  if (!outcome.converged()) return outcome;
  mark_weak(system, lambda, set);
  return outcome;
}

}  // namespace catena
