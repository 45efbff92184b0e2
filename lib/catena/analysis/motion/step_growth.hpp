// Control of steps by their error: the factor from one step to the next,
//
//   f = s error^(-1/p), not below f_min and not above f_max
//
// with p the order of the method and the error in units of what is allowed, s = 0.9 so that most steps are accepted.
// Source: E. Hairer, S. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", section II.4, which has s from
// 0.8 to 0.9 and f_max from 1.5 to 5; an error below 1e-10 (0 among them) grows by f_max at any order in use.
#pragma once

#include <algorithm>
#include <cmath>

namespace catena {

/// Steps of time below this part of the time itself, or of what is left of it, are rounding: some 450 epsilon, so that
/// instants within them still lie apart by several roundings.
inline constexpr double shortest_step = 1e-13;

/// A hundred steps in a row that are rejected leave no digit of time.
inline constexpr int most_rejections = 100;

/// s and f_min, which methods with rules of their own share. A cut to a fifth leaves an error of order 5 in one of
/// three thousand: what still fails then is no matter of the step.
inline constexpr double step_safety = 0.9, largest_cut = 0.2;

inline double step_growth(double error, int order) {
  constexpr double largest_growth = 2.5;  // f_max
  return std::clamp(step_safety * std::pow(std::max(error, 1e-10), -1.0 / order), largest_cut, largest_growth);
}

}  // namespace catena
