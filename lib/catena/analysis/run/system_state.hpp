// The state of a mechanism, passed from one analysis of a scene to the next: absolute, in model order, so that it stays
// valid for other plans and parameters.
#pragma once

#include <vector>

namespace catena {

struct SystemState {
  double t = 0;
  std::vector<double> q;   ///< [x, y, phi] of every body's centroid, m, m, rad; empty: the given configuration
  std::vector<double> qd;  ///< velocities; empty: none known
};

}  // namespace catena
