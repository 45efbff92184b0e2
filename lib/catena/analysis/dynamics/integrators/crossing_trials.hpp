// Which sizes of a step are tried across a singular position, where accelerations lose digits on both sides.
//
// A shorter step would only end nearer to the position. So a step that is not exact enough is repeated with all its
// stages projected, then with other sizes, so that neither its end nor a stage lies beside the position; at last the
// best of these is taken if its error is acceptable. One that has the position behind it is better than all that only
// come nearer: from there the passage would be worse. Used by any method whose stages tell ratios of pivots
// (stage_ratios.hpp). Source: apps/manual/numerics.md#singular-passages.
#pragma once

#include <array>
#include <cmath>
#include <optional>

namespace catena {

/// Ratios of pivots of a step: at its start, the smallest of its stages, at its end.
struct StepRatios {
  double start = 1, smallest = 1, end = 1;

  /// Whether the singular position lies within the step.
  bool pass() const { return smallest < passed * end; }

 private:
  // Of the ratio at the end: a stage that is so much nearer to the position lies before it, or it is passed.
  static constexpr double passed = 0.3;
};

class CrossingTrials {
 public:
  /// `tolerance` of a step: where a ratio of pivots is below a limit that follows from it, no step should end.
  explicit CrossingTrials(double tolerance);

  /// A step begins.
  void begin();
  bool project_stages() const { return projecting_; }
  /// The error that is accepted, in tolerances; that of rounding does not count where the best step is taken.
  double accepted_error() const { return accepted_error_; }
  bool takes_best() const { return taking_best_; }
  bool made_detours() const { return detours_ > 0; }

  /// The step is to be repeated with projected stages.
  void begin_projecting();
  /// Another size in place of h (s), so that neither the end nor a stage lies beside the position; nothing: all were
  /// tried. `error`: of the step of size h, in tolerances.
  std::optional<double> detour(double h, double error, const StepRatios& ratios);
  /// A step of size h with projected stages is not exact enough: the size that is tried next, or nothing.
  std::optional<double> next(double h, double error, double rounding, const StepRatios& ratios);

  /// Whether a step that is exact enough ends too near to the position, and is not known to do so for want of others.
  bool ends_too_near(double ratio);
  /// No detour helps: steps may end here until the position is passed.
  void end_near() { ending_near_ = true; }
  bool is_ending_near() const { return ending_near_; }

 private:
  // The two sizes that avoid the position and the six others (crossing_trials.cpp).
  static constexpr std::size_t most_detours = 8;
  std::array<double, most_detours> sizes_{};  // s, in place of that of the step
  std::size_t count_ = 0, detours_ = 0;
  double least_end_ratio_ = 0, best_error_ = 0, best_step_ = 0, accepted_error_ = 1;
  bool projecting_ = false, best_passes_ = false, taking_best_ = false, ending_near_ = false;
};

}  // namespace catena
