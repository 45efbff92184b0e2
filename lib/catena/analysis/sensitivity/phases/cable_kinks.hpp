// Elastic cables, and ropes over pulleys, that become taut or slack in a motion in which they act as forces: there
// f = k max(l - L, 0) has a kink, and its derivative
//
//   f_p = k (l_p - L_p) where l > L, else 0
//
// jumps at an instant that moves. Motions with derivatives that pass such an instant follow cables as gaps
// (model/elastic_gaps.hpp), at the cost of phases, and end steps there; where they stay forces, because a law of state
// reads one or the run's error is estimated, steps do not end there, and derivatives carried over such a step miss by k
// l_p times its length, whatever the tolerance: they are not given. Told from samples of every step; a cable that is at
// its length to rounding is on the side on which it is found next. Units: m.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/model/model.hpp"

namespace catena {

class CableKinks {
 public:
  explicit CableKinks(const Model& model);
  /// Why a motion has no derivatives from this stretch on; empty: no cable passes its kink in it.
  std::string passed(const MotionStretch& stretch);

 private:
  std::vector<int> side_;  // by cable, then by rope: 1 slack, -1 taut, 0 not known yet
};

/// Looks at a motion until a cable passes its kink.
class KinkLook final : public RowObserver {
 public:
  KinkLook(const Model& model, const std::atomic<bool>* cancel) : kinks_(model), cancel_(cancel) {}

  bool passed() const { return passed_; }
  bool observe(const Snapshot& snapshot) override { return proceed(snapshot.t); }
  bool proceed(double) override { return !(cancel_ && cancel_->load()); }
  bool wants_stretches() const override { return true; }
  bool cover(const MotionStretch& stretch) override {
    passed_ = !kinks_.passed(stretch).empty();
    return !passed_;
  }

 private:
  CableKinks kinks_;
  const std::atomic<bool>* cancel_;
  bool passed_ = false;
};

}  // namespace catena
