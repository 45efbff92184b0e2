// A turn of the motion where two branches nearly meet: steps that left their branch (branch_keeping.hpp) are repeated
// shorter until they follow it round its corner. Where that takes too many, the corner is one that rounding does not
// let steps follow: the passage is then crossed as one where branches cross, and judged no more. How often the motion
// went straight on, and why, is counted.
#pragma once

#include <cstdint>
#include <utility>

namespace catena {

/// Passages of one kind.
struct PassageCount {
  std::int64_t times = 0;
  double first = 0;  ///< s

  void add(double t) {
    if (times++ == 0) first = t;
  }
};

class BranchTurn {
 public:
  /// The first step that is tried where one had left its branch, compared with that.
  static constexpr double shortened = 0.125;

  bool is_under_way() const { return turning_; }
  bool is_given_up() const { return crosses_; }
  /// A step of size h (s) has left its branch, which passes another one at this distance (rad, length scales).
  void begin(double h, double gap) {
    if (!turning_) {
      ++turns_;
      tries_ = 0;
      step_that_left_ = h;
      gap_before_ = gap_;
    }
    turning_ = true;
    gap_ = gap;
  }
  /// Counts a try of a step that ends at t (s). True: the turn took too many, and is given up.
  bool gives_up(double t) {
    if (!turning_ || ++tries_ <= most_tries) return false;
    turning_ = false;
    crosses_ = true;
    --turns_;
    go_straight_on(t, std::exchange(gap_, gap_before_));
    return true;
  }
  /// A step that ends at t (s) goes straight on where its branch turns, at this distance from another one.
  void go_straight_on(double t, double gap) {
    straight_on_.add(t);
    if (straight_on_.times == 1) gap_straight_on_ = gap;
  }
  /// Such a step passes where branches cross, or cannot be judged; once a passage.
  void cross(double t) {
    if (!std::exchange(noted_, true)) crossings_.add(t);
  }
  void pass_unjudged(double t) {
    if (!std::exchange(noted_, true)) unjudged_.add(t);
  }
  /// The passage is over.
  void end() { turning_ = crosses_ = noted_ = false; }

  double step_that_left() const { return step_that_left_; }
  std::int64_t turns() const { return turns_; }
  /// Of the last turn, and of the first passage straight on where the branch turns: how far from each other the
  /// branches pass, rad or length scales.
  double gap_of_turn() const { return gap_; }
  double gap_straight_on() const { return gap_straight_on_; }
  /// Straight on where the branch turns, where branches cross, and unjudged.
  const PassageCount& straight_on() const { return straight_on_; }
  const PassageCount& crossings() const { return crossings_; }
  const PassageCount& unjudged() const { return unjudged_; }

 private:
  /// Steps, with those that are rejected, in which a motion must have turned into the other direction: twice as many as
  /// parallel cranks off by 1e-10 need at a tolerance of 1e-10.
  static constexpr int most_tries = 500;
  bool turning_ = false, crosses_ = false, noted_ = false;
  int tries_ = 0;
  double step_that_left_ = 0;        // s, the first in this passage
  double gap_ = 0, gap_before_ = 0;  // of the last turn, and of the one before
  double gap_straight_on_ = 0;
  std::int64_t turns_ = 0;
  PassageCount straight_on_, crossings_, unjudged_;
};

}  // namespace catena
