// Driven linkages of any size whose motion is known in closed form: the mechanisms of mechanisms.hpp with the exact
// place of what moves, in 64-bit-mantissa arithmetic.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/model/model.hpp"

namespace bench {

struct DrivenProblem {
  const char* name;
  std::shared_ptr<catena::Model> (*make)(int size);
  /// Largest error of the configuration q (x, y, phi of every body, in the order of the model) at t.
  double (*error)(std::span<const double> q, int size, double t);
  const char* error_of;
  int bodies_per_size;  ///< about
  double rounding;      ///< what the error may be beside the tolerance, with its reason in driven_problems.cpp
};

/// Four-bars in a row, a scissor lift, a row of gears, cams on a shaft.
std::span<const DrivenProblem> driven_problems();

}  // namespace bench
