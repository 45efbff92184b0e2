// How far along its path a row at flutter may be from the place where two values meet.
//
//   D(s) = ((omega2_a - omega2_b) / 2)^2,  -b^2 of a pair omega2 +- i b        D = 0 at the place, with a slope
//
// Two equal values count as real until D is further below zero than rounding (circulatory_modes.hpp), and the search
// ends there: the row is off by that rounding over D'. Aside from the row D is as good as its rounding: s(D = 0) by
// inverse interpolation of four places about the row, at three distances, is off by what these differ by.
//
//   e = max |s(D = 0)| + 2 sqrt(mean of (s(D = 0) - their mean)^2)
//
// Units: of the length of a path (path_system.hpp).
#pragma once

#include "catena/analysis/stability/path_system.hpp"

namespace catena {

/// `tangent`: of the path at the row. Not a number where D is not found, or has no slope.
double flutter_place_error(PathSystem& path, const PathPoint& row, const PathPoint& tangent);

}  // namespace catena
