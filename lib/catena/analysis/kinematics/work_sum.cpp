#include "catena/analysis/kinematics/work_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/columns/energy.hpp"

namespace catena {
namespace {

// Parts of the energy exchanged so far: the error allowed in a stretch, above which it is repeated in shorter ones; and
// the total error above which results carry a warning. Both include rounding of energies.
constexpr double allowed_part = 1e-10, doubtful_error = 1e-6, work_rounding = thresholds::carried_rounding;
// Where a law jumps, or friction turns round, the shortest stretch is wrong by some half of what it exchanges: 1e-8 rad
// of the motion. Without them powers bend only towards dead points, where they have no bound: then the square root of
// this.
constexpr double shortest_part = 1.0 / (1 << 24);

constexpr std::array<double, 4> weights = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                           0.17392742256872693};
// Weights that extract the cubic part of a power from its four values; absolute sum one.
constexpr std::array<double, 4> cubic = {-0.14153, 0.35847, -0.35847, 0.14153};

}  // namespace

void WorkSum::begin(const Evaluator& evaluator) {
  account_.emplace(evaluator);
  work_.assign(account_->size(), 0.0);
  power_.resize(account_->size());
  driver_work_.assign(evaluator.model().elements.size(), 0.0);
  cubic_part_.resize(account_->size());
  evaluator_ = &evaluator;
  samples_.begin(evaluator);
  exchanged_ = unsure_ = 0;
  part_ = 1;
}

void WorkSum::take_initial_energy(const Snapshot& start) { initial_energy_ = total_energy(start); }

// The energy that the sums do not account for.
double WorkSum::gap(const Snapshot& now) const {
  return total_energy(now) - initial_energy_ - EnergyAccount::supplied(work_) + EnergyAccount::dissipated(work_);
}

// The size at which energies are rounded.
double WorkSum::energy_scale(const Snapshot& now) const {
  return kinetic_energy(now) + std::abs(now.evaluator.potential_energy()) + std::abs(initial_energy_);
}

double WorkSum::stretch_length(double limit, double speed, double gain) const {
  // From rest the rates give no estimate: the whole way is tried first.
  double length = limit;
  if (speed > 0) length = std::min(length, thresholds::driven_stretch / speed);
  if (gain > 0) length = std::min(length, std::sqrt(thresholds::driven_stretch / gain));
  return part_ * length;
}

void WorkSum::begin_stretch(const Snapshot& start) {
  work_before_ = work_;
  exchanged_before_ = exchanged_;
  gap_before_ = gap(start);
  std::fill(cubic_part_.begin(), cubic_part_.end(), 0.0);
  largest_power_ = 0;
}

void WorkSum::see_end(bool first, std::span<const double> qd) {
  samples_.take(first ? 0 : PowerSamples::places - 1, evaluator_->dissipation(qd), evaluator_->load_power(qd), qd);
}

void WorkSum::add_point(std::size_t point, double span, std::span<const double> qd, std::span<const double> lambda,
                        double lost) {
  account_->powers(qd, lambda, power_);
  const std::span<const double> powers(power_);
  samples_.take(1 + point, EnergyAccount::dissipated(powers), EnergyAccount::of_loads(powers), qd);
  EnergyAccount::dissipated(std::span(power_)) += lost;
  for (std::size_t c = 0; c < work_.size(); ++c) {
    const double part = span * weights[point] * power_[c];
    work_[c] += part;
    exchanged_ += std::abs(part);
    cubic_part_[c] += cubic[point] * power_[c];
    largest_power_ = std::max(largest_power_, std::abs(power_[c]));
  }
}

double WorkSum::stretch_error(double span, const Snapshot& end) const {
  double rough = 0;
  for (double part : cubic_part_) rough = std::max(rough, std::abs(part));
  return std::max({std::abs(gap(end) - gap_before_), samples_.error(span),
                   rough > PowerSamples::unresolved * largest_power_ ? rough * std::abs(span) : 0.0});
}

// To 1/256 of the longest stretch, or 0.8 mrad: a pulse that is a third of that shows itself.
bool WorkSum::skips_switches() const { return part_ > std::cbrt(shortest_part) && samples_.may_switch(); }

double WorkSum::allowed_error(const Snapshot& end) const {
  return allowed_part * exchanged_ + work_rounding * energy_scale(end);
}

bool WorkSum::can_be_shorter() const {
  const bool bends = !evaluator_->model().laws.empty() || samples_.rubs();
  return part_ > (bends ? shortest_part : std::sqrt(shortest_part));
}

void WorkSum::take_back() {
  work_ = work_before_;
  exchanged_ = exchanged_before_;
  part_ /= 4;
}

void WorkSum::keep(double error, double allowed) {
  if (error > allowed) unsure_ += error;
  samples_.go_on();
  if (error < allowed / 64) part_ = std::min(1.0, 2 * part_);
}

void WorkSum::show(Snapshot& row) const {
  row.work = EnergyAccount::supplied(work_);
  row.dissipated = EnergyAccount::dissipated(work_);
  row.driver_work = driver_work_;
  row.initial_energy = initial_energy_;
}

void WorkSum::show_unknown(Snapshot& row, std::size_t elements) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  row.work = row.dissipated = none;
  driver_work_.assign(elements, none);
  row.driver_work = driver_work_;
  row.initial_energy = initial_energy_;
}

std::string WorkSum::doubt() const {
  if (!account_ || !(unsure_ > doubtful_error * exchanged_)) return {};
  return fmt::format(
      "work is accurate to {:.2g} J only, of {:.3g} J exchanged: loads change too fast for the motion, or "
      "grow near a singular configuration",
      unsure_, exchanged_);
}

}  // namespace catena
