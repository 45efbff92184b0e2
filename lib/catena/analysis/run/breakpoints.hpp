// Breakpoints of functions of time: where f, f', f'' or f''' jumps, and what is made of f is smooth on either side
// only.
//
// Instants closer than 1e-13 |t| are the same to functions of time. Units: s.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catena/base/time_function.hpp"

namespace catena {

template <class S>
bool is_breakpoint(const TimeFunction<S>& function, double t) {
  // Clearly before t, though not by much more than the rounding of instants.
  const double slack = std::max(4e-13 * std::abs(t), std::numeric_limits<double>::min());
  return function.next_breakpoint(t - slack) <= t + slack;
}

/// Those of several functions.
class Breakpoints {
 public:
  explicit Breakpoints(const std::vector<TimeFunction<double>>& functions) {
    for (const TimeFunction<double>& function : functions) {
      if (!function.is_constant()) functions_.push_back(function);
    }
  }

  /// The first one later than t; infinity if there is none.
  double next(double t) const {
    double first = std::numeric_limits<double>::infinity();
    for (const TimeFunction<double>& function : functions_) first = std::min(first, function.next_breakpoint(t));
    return first;
  }
  bool contain(double t) const {
    return std::any_of(functions_.begin(), functions_.end(),
                       [t](const TimeFunction<double>& function) { return is_breakpoint(function, t); });
  }

 private:
  std::vector<TimeFunction<double>> functions_;
};

}  // namespace catena
