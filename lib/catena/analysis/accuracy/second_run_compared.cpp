// SecondRun: the rows of both runs beside each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "catena/analysis/accuracy/disturbance.hpp"
#include "catena/analysis/accuracy/second_run_rows.hpp"
#include "catena/analysis/dynamics/error_estimate.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

constexpr double unknown_error = std::numeric_limits<double>::quiet_NaN();
// The difference of two runs is the error of one less that of the other: so many times it is enough where the error of
// the better run is up to half of the other's.
constexpr double factor_of_difference = 2;
// Of the largest difference of its unit a column that differs at all counts at least this part: by chance it may differ
// little in all rows, across the direction of the error, or where two errors have the same value on their ways.
constexpr double part_of_largest = 0.05;
// Places are further off than equations: one of 10,116 columns of baumgarte was by 14 times.
constexpr double leverage = 4;

// Units of places, rates and accelerations.
bool is_of_bodies(UnitKind unit) {
  return unit == UnitKind::length || unit == UnitKind::angle || unit == UnitKind::velocity ||
         unit == UnitKind::angular_velocity || unit == UnitKind::acceleration || unit == UnitKind::angular_acceleration;
}

bool is_place(UnitKind unit) { return unit == UnitKind::length || unit == UnitKind::angle || unit == UnitKind::time; }
bool is_rate(UnitKind unit) {
  return unit == UnitKind::velocity || unit == UnitKind::angular_velocity || unit == UnitKind::momentum ||
         unit == UnitKind::angular_momentum || unit == UnitKind::energy;
}

}  // namespace

// At the start both runs have the same changes, at the same instant; and rows at events lie before what these do.
void SecondRun::find_jumps(const MotionChanges& first, const MotionChanges& second, const OtherRows& other) {
  std::vector<std::pair<double, std::size_t>> instants;
  for (std::size_t row = 0; row < rows_.t.size(); ++row) instants.emplace_back(rows_.t[row], row);
  std::sort(instants.begin(), instants.end());
  jumps_.assign(rows_.t.size(), Jump::none);
  for (std::size_t k = 0; k < first.all().size(); ++k) {
    const MotionChange& change = first.all()[k];
    if (change.t == motion_.first) continue;
    const double reach = factor_of_difference * std::abs(change.t - second.all()[k].t) +
                         thresholds::same_instant * std::abs(change.t - motion_.first);
    for (auto at = std::lower_bound(instants.begin(), instants.end(), std::pair{change.t - reach, std::size_t{0}});
         at != instants.end() && at->first <= change.t + reach; ++at) {
      const bool own_row = change.has_row && at->first == change.t && other.t[at->second] == second.all()[k].t;
      if (own_row) continue;
      Jump& jump = jumps_[at->second];
      jump = std::max(jump, change.jolts ? Jump::of_rates : Jump::of_forces);
    }
  }
}

// Whether a column of this kind is continuous where a row lies.
bool SecondRun::is_judged(UnitKind unit, std::size_t row) const {
  return is_place(unit) || jumps_[row] == Jump::none || (jumps_[row] == Jump::of_forces && is_rate(unit));
}

// Both runs drift in the same way: places by what equations miss, times the leverage that these have, velocities and
// accelerations by as much as that changes.
double SecondRun::error_of_drift(UnitKind unit) const {
  const double off = motion_.drift, rate = motion_.rate, turned = off / motion_.length;
  switch (unit) {
    case UnitKind::length:
      return leverage * off;
    case UnitKind::velocity:
      return off * rate;
    case UnitKind::acceleration:
      return off * rate * rate;
    case UnitKind::angle:
      return leverage * turned;
    case UnitKind::angular_velocity:
      return turned * rate;
    case UnitKind::angular_acceleration:
      return turned * rate * rate;
    default:
      return 0;
  }
}

// 0 where none of its rows is judged, or has values.
double SecondRun::largest_difference(const OtherRows& other, std::size_t column) const {
  const std::size_t width = columns_.size();
  double largest = 0;
  for (std::size_t row = 0; row < rows_.t.size(); ++row) {
    const double difference = std::abs(rows_.values[row * width + column] - other.values[row * width + column]);
    if (is_judged(columns_.info()[column].unit, row) && difference > largest) largest = difference;
  }
  return largest;
}

void SecondRun::compare_with_tolerance(const OtherRows& other, double tolerance) {
  const double apart = rows_.places.largest_difference(other.places, motion_.length);
  const double multiple = apart / std::abs(tolerance - runs_.tolerance);
  if (multiple <= EstimatedError::largest_multiple) return;
  doubt_ = fmt::format(
      "the motion is off by some {:.2g} tolerances: {:.2g} length scales or rad, by a run at tolerance {:.3g}; errors "
      "of its steps add up to that; give a tolerance of {:.1g}, or another method, unless small errors grow fast in "
      "this motion",
      multiple, multiple * runs_.tolerance, tolerance,
      std::max(DynamicsOptions::least_tolerance, EstimatedError::largest_multiple / 2 * runs_.tolerance / multiple));
}

// The size of which the rounding of a value is a part: places turn and move with the mechanism, also near zero.
double SecondRun::rounded_size(UnitKind unit, double value) const {
  if (unit == UnitKind::angle) return std::max(std::abs(value), 1.0);
  return unit == UnitKind::length ? std::max(std::abs(value), motion_.length) : std::abs(value);
}

void SecondRun::compare(const OtherRows& other, const MotionRounding& rounding, double common) {
  const std::size_t width = columns_.size();
  std::vector<std::string> unjudged, alone;
  std::map<UnitKind, double> largest;
  for (std::size_t k = 0; k < width; ++k) {
    double& of_unit = largest[columns_.info()[k].unit];
    of_unit = std::max(of_unit, largest_difference(other, k));
  }
  for (std::size_t k = 0; k < width; ++k) {
    const ColumnInfo& column = columns_.info()[k];
    const double least = rounding.least_error(column.unit);
    bool judged = true, differs = false;
    std::size_t acting = 0;  // rows in which it is not zero
    for (std::size_t row = 0; row < rows_.t.size() && judged; ++row) {
      const double t = rows_.t[row], value = rows_.values[row * width + k], beside = other.values[row * width + k];
      judged = is_judged(column.unit, row);
      if (std::isnan(value) && std::isnan(beside)) continue;
      const double late = motion_.timed ? std::abs(t) * motion_.rate : 0;
      const double relative = common + Disturbance::epsilon * late;
      // Instants of rows are given.
      const bool given = column.unit == UnitKind::time && value == beside;
      const double own = given ? 0 : relative * rounded_size(column.unit, value);
      differs |= std::abs(value - beside) > own;
      acting += value != 0 || beside != 0;
      errors_.take_error(k, factor_of_difference * std::abs(value - beside) + own + least);
    }
    if (differs && is_of_bodies(column.unit))
      errors_.take_error(k, factor_of_difference * part_of_largest * largest[column.unit]);
    if (const double drift = error_of_drift(column.unit); drift > 0) errors_.take_error(k, drift);
    // Where it is not zero in one row alone the two errors may agree there by chance, and nothing else tells.
    if (differs && acting == 1 && rows_.t.size() > 1 && !is_of_bodies(column.unit)) {
      errors_.take_error(k, unknown_error);
      alone.push_back(column.name);
      continue;
    }
    if (judged) continue;
    errors_.take_error(k, unknown_error);
    unjudged.push_back(column.name);
  }
  const auto tell = [this](const std::vector<std::string>& columns, std::string_view reason) {
    if (columns.empty()) return;
    why_ += fmt::format("{}no digits are claimed of {} column{}: {} ({})", why_.empty() ? "" : "; ", columns.size(),
                        columns.size() == 1 ? "" : "s", reason, columns.front());
  };
  tell(unjudged, "a row lies where they jump, as near as that is known");
  tell(alone, "of what is zero in all rows but one, one difference alone is known");
}

}  // namespace catena
