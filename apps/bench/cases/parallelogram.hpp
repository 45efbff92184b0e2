// The exact motion of IFToMM's A02, n four-bars of 1 m side by side whose cranks turn alike: theta'' = -k cos(theta),
// by a symplectic composition of order 6 in small steps and 64 bits.
#pragma once

#include "catena/base/vec2.hpp"

namespace bench {

class Parallelogram {
 public:
  explicit Parallelogram(int n) : k_(9.81L * ((n + 1) / 2.0L + n) / ((n + 1) / 3.0L + n)) {}
  /// The end of the first crank at t, s; times must not decrease.
  catena::Vec2<double> crank_end(double t);

 private:
  long double k_, angle_ = 1.57079632679489661923L, rate_ = -1, t_ = 0;
};

}  // namespace bench
