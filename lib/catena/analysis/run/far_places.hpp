// The rounding of lengths between places far from the origin, in length scales: redundant constraints agree no better
// there, nor do equations whose ground places are not taken relative to a body's (curves on the ground).
//
//   8 eps max |place of a body| / length scale        at most what counts as a contradiction
#pragma once

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena {

/// Rounding of coordinates and of what is computed from them, relative to their size.
inline constexpr double attainable_digits = 2 * thresholds::few_roundings;

inline double rounding_of_far_places(const Evaluator& evaluator) {
  double place = 0;
  for (int p = 0; p < evaluator.plan().bodies; ++p) {
    const Vec2<double> origin = evaluator.origin(p);
    place = std::max({place, std::abs(origin.x), std::abs(origin.y)});
  }
  return std::min(thresholds::contradiction, attainable_digits * place / evaluator.length_scale());
}

}  // namespace catena
