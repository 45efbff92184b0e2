// How near the stages of a step come to a singular position: ratios of the smallest pivot of the Schur complement,
// which fall with the square of the distance, compared with the largest ratio so far (very unequal masses make all
// small).
//
// Rounding of places makes accelerations at a sine d, d^2 the ratio, wrong by eps / d^3; what the stages of a step make
// of it is proportional to its roughness, sum |b_s| / d_s^3.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catena/analysis/motion/tableau.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {

class StageRatios {
 public:
  /// `usual`: the smallest ratio in usual places where the start is none (RedundantRows::generic_ratio).
  StageRatios(std::size_t stages, double usual) : of_stage_(stages, 1.0), usual_(std::max(1e-300, usual)) {}

  double usual() const { return usual_; }
  void set_usual(double ratio) { usual_ = ratio; }
  double compared(double ratio) const { return ratio / usual_; }

  /// At the start of a step.
  void start(double ratio) {
    usual_ = std::max(usual_, ratio);
    start_ = compared(ratio);
  }
  double at_start() const { return start_; }

  void begin() {
    smallest_ = std::numeric_limits<double>::infinity();
    largest_ = start_;
  }
  void note(std::size_t stage, double ratio) {
    of_stage_[stage] = compared(ratio);
    smallest_ = std::min(smallest_, of_stage_[stage]);
    largest_ = std::max(largest_, of_stage_[stage]);
  }
  /// Of a stage that is evaluated for the interpolant.
  void note_between(double ratio) { smallest_ = std::min(smallest_, compared(ratio)); }
  double smallest() const { return smallest_; }

  /// Whether a singular position lies within the step. Light parts make all ratios small without any.
  bool dip() const { return smallest_ < std::min(dependence::singular_passage, dependence::unusual * largest_); }

  void find_roughness(const StageSum& weights) {
    roughness_ = 0;
    of_stage_[0] = start_;
    for (const StageTerm& term : weights) {
      const double sine = std::sqrt(of_stage_[static_cast<std::size_t>(term.stage)]);
      roughness_ += std::abs(term.weight) / (sine * sine * sine);
    }
  }
  double roughness() const { return roughness_; }

 private:
  std::vector<double> of_stage_;
  double smallest_ = 1, largest_ = 1, start_ = 1, usual_ = 1e-300, roughness_ = 0;
};

}  // namespace catena
