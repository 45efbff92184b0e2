// The search for critical loads outwards from the present value of a parameter: its first step, and the order in which
// loads are told.
//
// The first step is one over which the stiffness, or the spectrum, changes by a few percent of itself: far above
// rounding, and well before the first load. It is bracketed between a step that changes too little and one that changes
// too much, or that the scene does not allow.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {

class FirstLoadStep {
 public:
  /// A change below this part is none.
  static constexpr double no_change = 1e-11;
  /// What a first step changes at least, in parts of the stiffness or the spectrum.
  static constexpr double least_change = 0.02;

  explicit FirstLoadStep(double present) : step_(present != 0 ? 0.1 * std::abs(present) : 1) {}

  double step() const { return step_; }
  /// The scene does not allow the present step.
  void refuse() { too_large_ = step_; }
  bool is_refused() const { return !(step_ < too_large_); }
  /// What the present step changes; whether it will do.
  bool take(double change) {
    if (change >= least_change && change <= most_change) return true;
    (change < least_change ? too_small_ : too_large_) = step_;
    return false;
  }
  /// To the next step, after a change by the present one; false where the change jumps: both sides of the jump are
  /// searched.
  bool move(double change) {
    if (too_small_ > 0 && std::isfinite(too_large_)) {
      if (too_large_ < 1.001 * too_small_) return false;
      step_ = std::sqrt(too_small_ * too_large_);
    } else if (std::isfinite(too_large_)) {
      step_ /= fine;
    } else {
      // No further than the change so far allows: an oscillating dependence must not be stepped over.
      step_ *= std::clamp(std::sqrt(least_change * most_change) / change, fine, coarse);
    }
    return true;
  }

 private:
  // And at most: half of itself, before the first mode that softens evenly is gone.
  static constexpr double most_change = 0.5;
  // Factors by which the step is looked for.
  static constexpr double coarse = 1e3, fine = 4;

  double step_, too_small_ = 0, too_large_ = std::numeric_limits<double>::infinity();
};

/// How far loads are looked for, in first steps: one beyond would be 1e8 times a value that already changes the
/// stiffness visibly.
inline constexpr double farthest_load = 1e8;
/// Parts of its distance by which a load is moved to see how stiffnesses change: what changes is far above rounding
/// there, and of what bends little is seen.
inline constexpr double load_difference = 1e-4;
/// Samples an octave of the distance from the present value, and within the first step.
inline constexpr int samples_an_octave = 6;
/// Calls f(distance) for growing distances up to `farthest` first steps, until it returns false.
template <class F>
void for_each_distance(double first_step, double farthest, F&& f) {
  const double growth = std::pow(2.0, 1.0 / samples_an_octave);
  for (double reach = first_step / samples_an_octave; reach <= farthest * first_step;
       reach = reach < first_step ? reach + first_step / samples_an_octave : reach * growth) {
    if (!f(reach)) return;
  }
}

/// Whether load `a` is told before load `b`: the nearer one, of two that lie equally far the positive one.
template <class Load>
bool comes_first(const Load& a, const Load& b) {
  const double near = std::abs(std::abs(a.distance) - std::abs(b.distance));
  if (near <= thresholds::solved * std::abs(a.distance)) return a.distance > b.distance;
  return std::abs(a.distance) < std::abs(b.distance);
}

}  // namespace catena
