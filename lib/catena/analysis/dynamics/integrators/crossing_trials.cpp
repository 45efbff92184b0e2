#include "catena/analysis/dynamics/integrators/crossing_trials.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// From this many times the least ratio at which a step may end, the position is passed.
constexpr double clear_of_end = 10;
// Where no step across a singular position is good enough, the best is taken if its error is below this.
constexpr double largest_crossing_error = 300;
constexpr double other_steps[] = {0.8, 0.6, 1.15, 0.4, 0.9, 1.3};  // what is tried instead of h ...
// ... and before them, near a singular position, steps that have it in the middle of the widest gaps between stages of
// order 8, 0.333 ... 0.6 and 0.651 ... 0.857 of a step, if they are not very different from h and their error, which
// grows with the eighth power, may stay below what is taken at last.
constexpr double gaps[] = {0.467, 0.754};
constexpr double least_aimed = 0.3, largest_aimed = 3;

}  // namespace

CrossingTrials::CrossingTrials(double tolerance)
    : least_end_ratio_(
          std::max(dependence::end_of_step, std::pow(dependence::lost_digits / std::sqrt(tolerance), 2.0 / 3))) {}

void CrossingTrials::begin() {
  detours_ = 0;
  projecting_ = taking_best_ = false;
  accepted_error_ = 1;
}

void CrossingTrials::begin_projecting() {
  projecting_ = true;
  best_error_ = std::numeric_limits<double>::infinity();
  best_step_ = 0;
  best_passes_ = taking_best_ = false;
}

std::optional<double> CrossingTrials::detour(double h, double error, const StepRatios& ratios) {
  static_assert(std::size(gaps) + std::size(other_steps) <= most_detours);
  if (detours_ == 0) {
    count_ = 0;
    // Pivots fall with the square of the distance.
    const double before = std::sqrt(ratios.start), after = std::sqrt(ratios.end) * (ratios.pass() ? 1 : -1);
    const double largest = std::min(largest_aimed, std::pow(largest_crossing_error / error, 0.125));
    for (const double gap : gaps) {
      const double part = before / ((before + after) * gap);
      if (part > least_aimed && part < largest) sizes_[count_++] = part * h;
    }
    for (const double part : other_steps) sizes_[count_++] = part * h;
  }
  if (detours_ == count_) return {};
  return sizes_[detours_++];
}

std::optional<double> CrossingTrials::next(double h, double error, double rounding, const StepRatios& ratios) {
  const double off = std::max(error, rounding);
  const bool better = ratios.pass() == best_passes_ ? off < best_error_ : ratios.pass();
  if (error < largest_crossing_error && better) {
    best_error_ = off;
    best_step_ = h;
    best_passes_ = ratios.pass();
  }
  if (const std::optional<double> other = detour(h, error, ratios)) return other;
  if (best_step_ == 0) return {};
  // Small masses may have been weighed anew since, and its rounding is another one by the new ratios of pivots.
  accepted_error_ = largest_crossing_error;
  taking_best_ = true;
  const double best = best_step_;
  best_step_ = 0;
  return best;
}

bool CrossingTrials::ends_too_near(double ratio) {
  if (ratio > clear_of_end * least_end_ratio_) ending_near_ = false;
  return ratio < least_end_ratio_ && !ending_near_;
}

}  // namespace catena
