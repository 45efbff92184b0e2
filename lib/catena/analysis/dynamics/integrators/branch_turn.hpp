// A turn of the motion where two branches nearly meet: steps that left their branch (branch_keeping.hpp) are repeated
// shorter until they follow it round its corner. Where that takes too many, the corner is one that rounding does not
// let steps follow: the passage is then crossed as one where branches cross, and judged no more.
#pragma once

#include <cstdint>

namespace catena {

class BranchTurn {
 public:
  /// The first step that is tried where one had left its branch, compared with that.
  static constexpr double shortened = 0.125;

  bool is_under_way() const { return turning_; }
  bool is_given_up() const { return crosses_; }
  /// A step of size h (s) has left its branch.
  void begin(double h) {
    if (!turning_) {
      ++turns_;
      tries_ = 0;
      step_that_left_ = h;
    }
    turning_ = true;
  }
  /// Counts a try of a step to t (s). True: the turn took too many, and is given up.
  bool gives_up(double t) {
    if (!turning_ || ++tries_ <= most_tries) return false;
    turning_ = false;
    crosses_ = true;
    --turns_;
    go_straight_on(t);
    return true;
  }
  /// Notes that the motion goes straight on at t (s) where its branch turns.
  void go_straight_on(double t) {
    if (straight_on_++ == 0) straight_on_t_ = t;
  }
  /// The passage is over.
  void end() { turning_ = crosses_ = false; }

  double step_that_left() const { return step_that_left_; }
  std::int64_t turns() const { return turns_; }
  std::int64_t straight_on() const { return straight_on_; }
  double straight_on_t() const { return straight_on_t_; }  // s, at first

 private:
  /// Steps, with those that are rejected, in which a motion must have turned into the other direction: twice as many as
  /// parallel cranks off by 1e-10 need at a tolerance of 1e-10.
  static constexpr int most_tries = 500;
  bool turning_ = false, crosses_ = false;
  int tries_ = 0;
  double step_that_left_ = 0;  // s, the first in this passage
  std::int64_t turns_ = 0, straight_on_ = 0;
  double straight_on_t_ = 0;
};

}  // namespace catena
