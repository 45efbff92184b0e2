#include "catena/analysis/accuracy/second_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "catena/analysis/accuracy/motion_accuracy.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double unknown_error = std::numeric_limits<double>::quiet_NaN();
// 30,087 columns of 1176 random mechanisms were optimistic by 2.5 at most of adams, whose order changes with the
// tolerance, by 3.6 of baumgarte, by 5.6 of partitioning, and pessimistic by 32, 42 and 13 at the median; 740 columns
// of 364 motions with contacts by 5.1 at most and by 16. Fixed steps of adams longer by a quarter alone were optimistic
// by 24, where errors of both had the same value on their ways.
constexpr double coarser_tolerance = 10, coarser_of_one_step = 4, coarser_step = 1.25, coarser_step_of_adams = 1.5;
// Beyond this a coarser run is of no use, and a finer one is made.
constexpr double largest_coarse = 1e-2;
constexpr double factor_of_difference = 2;
// Of the largest difference of its unit a column that differs at all counts at least this part: by chance it may differ
// little in all rows, across the direction of the error, or where two errors have the same value on their ways.
constexpr double part_of_largest = 0.05;
// Places are further off than equations: one of 10,116 columns of baumgarte was by 14 times.
constexpr double leverage = 4;
// Rounding that both runs have in common, or that the difference misses by chance: of the start, and of steps, which
// adds up as at random. Most columns of smooth motions at tolerances below 1e-8 are wrong by that alone.
constexpr double rounding_of_start = 8, rounding_of_steps = 2;
// Of a motion with changes, and of each of them, at which it starts anew at an instant of its own rounding: of 1122
// columns of motions with up to 22 changes one was off by 15 times the former alone.
constexpr double rounding_with_changes = 64, rounding_of_change = 16;
constexpr double factor_of_instants = 2, part_of_time = 1e-9;
// Evaluations times coordinates of the first run: about a second.
constexpr double most_work = 2e7;
// Of the first run: chains that fall on a floor passed the same ones at either tolerance with 9 links (151 changes),
// and no longer with 14 (350).
constexpr std::size_t most_changes = 300;
constexpr std::size_t most_numbers = 4'000'000;

// Units of places, rates and accelerations.
bool is_of_bodies(UnitKind unit) {
  return unit == UnitKind::length || unit == UnitKind::angle || unit == UnitKind::velocity ||
         unit == UnitKind::angular_velocity || unit == UnitKind::acceleration || unit == UnitKind::angular_acceleration;
}

// Relative; `changes` of the element that has most.
double common_rounding(double steps, std::size_t changes) {
  const double roundings = changes > 0 ? rounding_with_changes + rounding_of_change * static_cast<double>(changes)
                                       : rounding_of_start + rounding_of_steps * std::sqrt(steps);
  return roundings * std::numeric_limits<double>::epsilon();
}

bool is_place(UnitKind unit) { return unit == UnitKind::length || unit == UnitKind::angle || unit == UnitKind::time; }
bool is_rate(UnitKind unit) {
  return unit == UnitKind::velocity || unit == UnitKind::angular_velocity || unit == UnitKind::momentum ||
         unit == UnitKind::angular_momentum || unit == UnitKind::energy;
}

}  // namespace

DynamicsOptions coarser_options(const DynamicsOptions& options) {
  DynamicsOptions other = options;
  if (options.step > 0) {
    const bool adams = options.method == IntegrationMethod::adams;
    other.step = (adams ? coarser_step_of_adams : coarser_step) * options.step;
  } else {
    const bool one_step =
        options.method == IntegrationMethod::partitioning || options.method == IntegrationMethod::baumgarte;
    const double times = one_step ? coarser_of_one_step : coarser_tolerance;
    other.tolerance =
        times * options.tolerance <= largest_coarse ? times * options.tolerance : options.tolerance / times;
  }
  return other;
}

/// Keeps those rows of the second run whose like was kept of the first.
class SecondRun::OtherRows final : public RowObserver {
 public:
  OtherRows(const ColumnSet& columns, std::int64_t every, const std::function<bool()>& proceed)
      : columns_(columns), every_(every), proceed_(proceed), row_(columns.size()) {}
  bool observe(const Snapshot& snapshot) override {
    if (given++ % every_ != 0) return proceed_();
    columns_.evaluate(snapshot, row_);
    t.push_back(snapshot.t);
    values.insert(values.end(), row_.begin(), row_.end());
    return proceed_();
  }
  bool proceed(double) override { return proceed_(); }

  std::vector<double> t, values;
  std::int64_t given = 0;

 private:
  const ColumnSet& columns_;
  std::int64_t every_;
  const std::function<bool()>& proceed_;
  std::vector<double> row_;
};

void SecondRun::take(const Snapshot& snapshot, std::span<const double> values) {
  const std::span<const double> own = values.first(columns_.size());
  errors_.take_row(own);
  if (rows_.given == 0) {
    motion_.first = snapshot.t;
    motion_.length = snapshot.evaluator.length_scale();
    motion_.coordinates = at(snapshot.evaluator.plan().columns);
    motion_.timed = !snapshot.evaluator.model().functions.empty();
  }
  if (rows_.given++ % rows_.every != 0) return;
  rows_.t.push_back(snapshot.t);
  rows_.values.insert(rows_.values.end(), own.begin(), own.end());
  take_motion(snapshot);
  if (rows_.values.size() > most_numbers) thin_out();
}

// The rate of a motion is that by which its velocities change, and that by which its bodies turn.
void SecondRun::take_motion(const Snapshot& snapshot) {
  if (leaves_constraints_) motion_.drift = std::max(motion_.drift, snapshot.residual);
  if (!motion_.timed && !leaves_constraints_) return;
  double speed = 0, change = 0;
  for (std::size_t c = 0; c < snapshot.qd.size(); ++c) {
    const double unit = c % 3 == 2 ? 1 : motion_.length;
    speed = std::max(speed, std::abs(snapshot.qd[c]) / unit);
    if (c < snapshot.qdd.size()) change = std::max(change, std::abs(snapshot.qdd[c]) / unit);
  }
  motion_.rate = std::max({motion_.rate, speed, speed > 0 ? change / speed : 0});
}

void SecondRun::thin_out() {
  const std::size_t width = columns_.size(), left = (rows_.t.size() + 1) / 2;
  for (std::size_t row = 1; row < left; ++row) {
    rows_.t[row] = rows_.t[2 * row];
    std::copy_n(rows_.values.begin() + static_cast<std::ptrdiff_t>(2 * row * width), width,
                rows_.values.begin() + static_cast<std::ptrdiff_t>(row * width));
  }
  rows_.t.resize(left);
  rows_.values.resize(left * width);
  rows_.every *= 2;
}

std::vector<double> SecondRun::digits(const AnalysisReport& report) {
  why_.clear();
  if (!report.ok() || rows_.t.empty()) return {};
  const double work = static_cast<double>(report.counters.forces) * static_cast<double>(motion_.coordinates);
  if (work > most_work) {
    why_ = fmt::format(
        "no digits are claimed: they follow from a second run, which is not made where the first one takes {:.2g} "
        "evaluations times coordinates, more than {:.2g}",
        work, most_work);
    return {};
  }
  const MotionChanges first = runs_.first();
  if (first.all().size() > most_changes) {
    why_ = fmt::format(
        "no digits are claimed: they follow from a second run that passes the same changes, and the motion has {} of "
        "them; with more than {} two runs seldom do",
        first.all().size(), most_changes);
    return {};
  }
  auto other = std::make_unique<OtherRows>(columns_, rows_.every, runs_.proceed);
  Motion second = runs_.second(columns_.needs(), *other, false);
  if (second.report.counters.steps == report.counters.steps) {
    other = std::make_unique<OtherRows>(columns_, rows_.every, runs_.proceed);
    second = runs_.second(columns_.needs(), *other, true);
  }
  if (!second.report.ok()) {
    why_ = "no digits are claimed: the run beside it ended otherwise: " + second.report.message;
    return {};
  }
  if (const std::string difference = first.difference(second.changes); !difference.empty()) {
    why_ = "no digits are claimed: two runs pass different events, " + difference;
    return {};
  }
  if (other->given != rows_.given) {
    why_ = fmt::format("no digits are claimed: the run beside it has {} rows, not {}", other->given, rows_.given);
    return {};
  }
  find_jumps(first, second.changes, *other);
  compare(*other, second.rounding, common_rounding(static_cast<double>(report.counters.steps), first.most_of_one()));
  errors_.take_places(columns_.info(), motion_.length);
  return MotionAccuracy::claimed(errors_);
}

// At the start both runs have the same changes, at the same instant; and rows at events lie before what these do.
void SecondRun::find_jumps(const MotionChanges& first, const MotionChanges& second, const OtherRows& other) {
  std::vector<std::pair<double, std::size_t>> instants;
  for (std::size_t row = 0; row < rows_.t.size(); ++row) instants.emplace_back(rows_.t[row], row);
  std::sort(instants.begin(), instants.end());
  jumps_.assign(rows_.t.size(), Jump::none);
  for (std::size_t k = 0; k < first.all().size(); ++k) {
    const MotionChange& change = first.all()[k];
    if (change.t == motion_.first) continue;
    const double reach =
        factor_of_instants * std::abs(change.t - second.all()[k].t) + part_of_time * std::abs(change.t - motion_.first);
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

// The size of which the rounding of a value is a part: places turn and move with the mechanism, also near zero.
double SecondRun::rounded_size(UnitKind unit, double value) const {
  if (unit == UnitKind::angle) return std::max(std::abs(value), 1.0);
  return unit == UnitKind::length ? std::max(std::abs(value), motion_.length) : std::abs(value);
}

void SecondRun::compare(const OtherRows& other, const MotionRounding& rounding, double common) {
  const std::size_t width = columns_.size();
  std::vector<std::string> unjudged;
  std::vector<double> differences(width);
  std::map<UnitKind, double> largest;
  for (std::size_t k = 0; k < width; ++k) {
    double& of_unit = largest[columns_.info()[k].unit];
    differences[k] = largest_difference(other, k);
    of_unit = std::max(of_unit, differences[k]);
  }
  for (std::size_t k = 0; k < width; ++k) {
    const ColumnInfo& column = columns_.info()[k];
    const double least = rounding.least_error(column.unit);
    bool judged = true, differs = false;
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
      errors_.take_error(k, factor_of_difference * std::abs(value - beside) + own + least);
    }
    if (differs && is_of_bodies(column.unit))
      errors_.take_error(k, factor_of_difference * part_of_largest * largest[column.unit]);
    if (const double drift = error_of_drift(column.unit); drift > 0) errors_.take_error(k, drift);
    if (judged) continue;
    errors_.take_error(k, unknown_error);
    unjudged.push_back(column.name);
  }
  if (unjudged.empty()) return;
  why_ = fmt::format("no digits are claimed of {} column{}: a row lies where they jump, as near as that is known ({})",
                     unjudged.size(), unjudged.size() == 1 ? "" : "s", unjudged.front());
}

}  // namespace catena
