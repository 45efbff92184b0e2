// What errors of positions and velocities are compared with, so that one number serves all coordinates.
//
//   positions    tolerance x L (lengths), tolerance x 1 rad (angles)
//   velocities   tolerance x (V L + |v|), tolerance x (V + |omega|)
//
// L: the scene's length scale. V, in 1/s: the fastest the mechanism has been so far, and what its accelerations make of
// a displacement of L or 1 rad: max(|v|/L, |omega|, sqrt(|a|/L), sqrt(|alpha|)). An error of velocity then counts as
// much as the error of position it grows into.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace catena {

struct ErrorScale {
  double tolerance = 1e-8;
  double length = 1;
  double rate = 0;  ///< V, never falls

  /// Takes note of velocities and accelerations (three a body).
  void observe(std::span<const double> qd, std::span<const double> qdd) {
    double fastest = 0, strongest = 0;
    for (std::size_t c = 0; c + 2 < qd.size(); c += 3) {
      fastest = std::max({fastest, std::abs(qd[c]) / length, std::abs(qd[c + 1]) / length, std::abs(qd[c + 2])});
      strongest = std::max({strongest, std::abs(qdd[c]) / length, std::abs(qdd[c + 1]) / length, std::abs(qdd[c + 2])});
    }
    rate = std::max({rate, fastest, std::sqrt(strongest)});
  }
};

}  // namespace catena
