// How far a rope is wound, which its place alone does not say: a whole turn more or less looks alike.
//
//   theta_out = theta_in + b c        b: side of the pulley (1: left), c: angle of contact, below zero beside it
//
// c and theta belong to a place. They go on from one place to the next where no tangent turns by half a turn between.
// Units: rad.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

namespace catena {

/// Of a rope, or of the stretch of one between pulleys that roll. Not a number: nothing is known.
struct RopeTurns {
  double theta = std::numeric_limits<double>::quiet_NaN();  ///< direction of the first straight line
  std::vector<double> contact{};                            ///< c by node, ends included: these have none
  bool known() const { return !std::isnan(theta); }
};

}  // namespace catena
