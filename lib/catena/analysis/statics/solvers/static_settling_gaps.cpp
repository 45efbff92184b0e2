#include "catena/analysis/statics/solvers/static_settling_gaps.hpp"

#include <algorithm>

#include "catena/analysis/statics/solvers/static_active_set.hpp"
#include "catena/base/at.hpp"

namespace catena {

SettlingGaps::SettlingGaps(StaticSystem& system, ActiveSet& set, double tolerance)
    : system_(system), set_(set), tolerance_(tolerance) {
  set_ = {std::vector<char>(system.plan().gap_rows.size(), 0), std::vector<char>(system.plan().gap_rows.size(), 0)};
  system_.close_gaps(set_.closed);
}

double SettlingGaps::enough() const { return std::max(tolerance_, 100 * system_.rounding_change()); }

void SettlingGaps::begin(std::span<const double> q, double force) {
  force_ = force;
  tried_.clear();
  changes_ = 0;
  system_.close_gaps(std::vector<char>(set_.closed.size(), 1));
  system_.move_to(q);
  jacobian_.assign(system_.jacobian().begin(), system_.jacobian().end());
  gap_ = gap_values(system_);
}

void SettlingGaps::hold(std::span<const double> q, std::span<double> lambda) const {
  for (std::size_t k = 0; k < set_.closed.size(); ++k) {
    if (!set_.closed[k]) lambda[at(system_.plan().gap_rows[k])] = 0;
  }
  system_.close_gaps(set_.closed);
  system_.move_to(q);
}

bool SettlingGaps::change(std::span<const double> lambda, std::span<const double> changes) {
  const Plan& plan = system_.plan();
  const std::size_t columns = at(plan.columns);
  std::vector<double> moved(at(plan.rows), 0.0);
  multiply_add(plan.jacobian, jacobian_, changes.first(columns), moved);
  const bool alone = !tried_.insert(set_.closed).second || tried_.size() > most_sets_at_once;
  found_ = true;
  for (std::size_t k = 0; k < set_.closed.size(); ++k) {
    const std::size_t row = at(plan.gap_rows[k]);
    const GapUnits u = units_of(system_, plan.gap_rows[k], {system_.length(), force_});
    const double fault =
        set_.closed[k] ? (lambda[row] + changes[columns + row]) / u.force : -(gap_[k] + moved[row]) / u.gap;
    if (!(fault > enough())) continue;
    found_ = false;
    set_.closed[k] = !set_.closed[k];
    if (alone) break;
  }
  set_.changes += !found_;
  return !found_ && ++changes_ < most_sets;
}

double SettlingGaps::overlap() const {
  double deepest = 0;
  const std::vector<double> gap = gap_values(system_);
  for (std::size_t k = 0; k < gap.size(); ++k) {
    const double unit = units_of(system_, system_.plan().gap_rows[k], {system_.length(), 1}).gap;
    if (!set_.closed[k]) deepest = std::max(deepest, -gap[k] / unit);
  }
  return deepest;
}

bool SettlingGaps::hold_all(std::span<const double> lambda) const {
  const std::vector<double> faults = gap_faults(system_, lambda, set_.closed);
  return std::all_of(faults.begin(), faults.end(), [&](double fault) { return fault <= enough(); });
}

}  // namespace catena
