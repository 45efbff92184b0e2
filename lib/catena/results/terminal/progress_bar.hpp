// A progress bar on the standard error with the time left: drawn ten times a second at most, and only on a terminal.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace catena {

/// How long what is under way will still take, from its pace over at least the last half of its time: what a resumed
/// run takes from its record in a moment is soon forgotten.
class TimeLeft {
 public:
  /// At `now`, s of any clock, `fraction` of the work is done. Nothing while that says too little.
  std::optional<double> after(double now, double fraction);
  /// "40 s left", "12 min left", "3 h 20 min left".
  static std::string text(double seconds);

 private:
  struct Mark {
    double time = 0, fraction = 0;
  };
  std::optional<Mark> begin_;
  Mark older_, newer_;
};

class ProgressBar {
 public:
  /// Nothing is ever drawn unless `wanted` and the standard error is a terminal.
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { clear(); }

  bool visible() const { return visible_; }
  /// `fraction` of the work named `label` is done, 0 ... 1.
  void update(std::string_view label, double fraction);
  /// Wipes the bar away, so that a message can be printed.
  void clear();

  /// The bar as text, without moving any cursor: `kinematics [#####.....]  50 %`.
  static std::string text(std::string_view label, double fraction);

 private:
  bool visible_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point next_;
  std::string label_;  // of the work at hand
  TimeLeft left_;
};

}  // namespace catena
