// What a force element of two bodies exerts now, for the columns of springs: tension along the line P_i P_j, torque on
// i.
//
//   tension = F_i . h / |h|, h = r_Pj - r_Pi (positive pulls together)        torque n on body i, THEORY section 4
//
// At rest if the snapshot has no velocities. |h| = 0: the direction is lost, the tension reads 0. Units: N, N m.
#pragma once

#include "catena/columns/snapshot.hpp"

namespace catena {

struct SpringLoads {
  double tension = 0, torque = 0, slack = 0;
};

SpringLoads spring_loads(const Snapshot& snapshot, int element);

}  // namespace catena
