// A progress bar on the standard error: drawn ten times a second at most, and only on a terminal.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace catena {

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
};

}  // namespace catena
