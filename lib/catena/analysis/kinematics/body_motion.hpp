// How far a few bodies move: the norms of pose/scaling.hpp of vectors of three coordinates a body.
#pragma once

#include <cmath>
#include <cstddef>

#include "catena/analysis/pose/scaling.hpp"

namespace catena {

// Of fewer columns, eight bodies, the sizes of vectors are found body by body: Scaling's lanes are for more.
inline constexpr std::size_t few_columns = 24;

/// The largest shift and turn of some bodies; not a number where an entry is not finite.
class BodyMotion {
 public:
  void add(double x, double y, double phi) {
    const double dx = std::abs(x), dy = std::abs(y), turn = std::abs(phi), shift = dx > dy ? dx : dy;
    shift_ = shift > shift_ ? shift : shift_;
    turn_ = turn > turn_ ? turn : turn_;
    sum_ += dx + dy + turn;
  }
  Scaling::Size size(double length) const {
    const double shift = shift_ / length, nothing = sum_ - sum_;  // not a number, or zero
    return {(shift > turn_ ? shift : turn_) + nothing, turn_ + nothing};
  }

 private:
  double shift_ = 0, turn_ = 0, sum_ = 0;
};

}  // namespace catena
