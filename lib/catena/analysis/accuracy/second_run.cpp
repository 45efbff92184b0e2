#include "catena/analysis/accuracy/second_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/accuracy/motion_accuracy.hpp"
#include "catena/analysis/accuracy/second_run_rows.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// 66,753 columns of 2600 random mechanisms were optimistic by 5.8 at most of adams, whose order changes with the
// tolerance, by 4.5 of baumgarte, by 6.6 of partitioning, and pessimistic by 32, 42 and 14 at the median; 1694 columns
// of motions with contacts by 5.1 at most and by 17. Fixed steps of adams longer by a quarter alone were optimistic by
// 24, where errors of both had the same value on their ways.
constexpr double coarser_tolerance = 10, coarser_of_one_step = 4, coarser_step = 1.25, coarser_step_of_adams = 1.5;
// Beyond this a coarser run is of no use, and a finer one is made.
constexpr double largest_coarse = 1e-2;
// Rounding that both runs have in common, or that the difference misses by chance: of the start, and of steps, which
// adds up as at random. Most columns of smooth motions at tolerances below 1e-8 are wrong by that alone.
constexpr double rounding_of_start = 8, rounding_of_steps = 2;
// Of a motion with changes, and of each of them, at which it starts anew at an instant of its own rounding: of 1122
// columns of motions with up to 22 changes one was off by 15 times the former alone.
constexpr double rounding_with_changes = 64, rounding_of_change = 16;
// Evaluations times coordinates of the first run: about a second.
constexpr double most_work = 2e7;
// Of the first run: chains that fall on a floor passed the same ones at either tolerance with 9 links (151 changes),
// and no longer with 14 (350).
constexpr std::size_t most_changes = 300;
constexpr std::size_t most_numbers = 4'000'000;

// Relative; `changes` of the element that has most.
double common_rounding(double steps, std::size_t changes) {
  const double roundings = changes > 0 ? rounding_with_changes + rounding_of_change * static_cast<double>(changes)
                                       : rounding_of_start + rounding_of_steps * std::sqrt(steps);
  return roundings * std::numeric_limits<double>::epsilon();
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
  if (runs_.tolerance > 0) rows_.places.take(snapshot.q);
  take_motion(snapshot);
  if (rows_.values.size() + rows_.places.numbers() > most_numbers) thin_out();
}

// The rate of a motion is that by which its velocities change, and that by which its bodies turn.
void SecondRun::take_motion(const Snapshot& snapshot) {
  if (leaves_constraints_) motion_.drift = std::max(motion_.drift, snapshot.residual);
  const double speed = fastest_rate(snapshot, motion_.length);
  motion_.fastest = std::max(motion_.fastest, speed);
  if (!motion_.timed && !leaves_constraints_) return;
  double change = 0;
  for (std::size_t c = 0; c < snapshot.qdd.size(); ++c)
    change = std::max(change, std::abs(snapshot.qdd[c]) / (c % 3 == 2 ? 1 : motion_.length));
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
  rows_.places.thin_out();
  rows_.every *= 2;
}

std::vector<double> SecondRun::digits(const AnalysisReport& report) {
  why_.clear();
  doubt_.clear();
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
  const bool checks = runs_.tolerance > 0;
  auto other = std::make_unique<OtherRows>(columns_, rows_.every, runs_.proceed, checks);
  Motion second = runs_.second(columns_.needs(), *other, false);
  if (second.report.counters.steps == report.counters.steps) {
    other = std::make_unique<OtherRows>(columns_, rows_.every, runs_.proceed, checks);
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
  if (checks) compare_with_tolerance(*other, second.tolerance);
  find_jumps(first, second.changes, *other);
  second.rounding.take_rate(motion_.fastest);
  compare(*other, second.rounding, common_rounding(static_cast<double>(report.counters.steps), first.most_of_one()));
  errors_.take_places(columns_.info(), motion_.length);
  return MotionAccuracy::claimed(errors_);
}

}  // namespace catena
