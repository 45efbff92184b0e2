// The order of Runge-Kutta steps (8 or 5), and how often the step under way was rejected: where order 8 fails
// repeatedly, order 5 takes over for a while.
#pragma once

#include <cstdint>

#include "catena/analysis/motion/step_growth.hpp"
#include "catena/analysis/motion/tableau.hpp"

namespace catena {

class StepOrder {
 public:
  StepOrder(int order, bool may_lower) : order_(order), may_lower_(may_lower) {}

  const Tableau& tableau() const {
    return (order_ == 5 && !long_steps_) || low_steps_left_ > 0 ? dormand_prince_5() : dormand_prince_8();
  }
  /// The factor to the next step by the error of this one.
  double growth(double error) const { return step_growth(error, tableau().order); }
  /// A step begins; `long_steps`: of order 8, where short ones would end again and again beside a singular position.
  void begin(bool long_steps) {
    long_steps_ = long_steps;
    rejections_ = 0;
  }
  void reject() {
    if (++rejections_ % rejections_before_low == 0 && tableau().order == 8 && may_lower_) low_steps_left_ = low_run;
  }
  void accept() {
    if (low_steps_left_ == 0) return;
    --low_steps_left_;
    ++low_steps_;
  }
  void forget_rejections() { rejections_ = 0; }
  bool was_rejected() const { return rejections_ > 0; }
  bool gives_up() const { return rejections_ > most_rejections; }
  /// Steps of order 5 in place of 8.
  std::int64_t low_steps() const { return low_steps_; }

 private:
  // A step is cut to 0.2 of itself at most (step_growth.hpp): eight times in a row make it 2.6e-6 of what was tried, no
  // size of a smooth motion. Order 5 then makes so many steps that the place is behind it.
  static constexpr int rejections_before_low = 8, low_run = 30;
  int order_ = 8;
  bool may_lower_ = true, long_steps_ = false;
  int low_steps_left_ = 0, rejections_ = 0;
  std::int64_t low_steps_ = 0;
};

}  // namespace catena
