// What a force element of two bodies exerts now, for the columns of springs and bushings: tension along the line P_i
// P_j, torque on i, and force and moment on j.
//
//   tension = F_i . h / |h|, h = r_Pj - r_Pi (positive pulls together)        torque n on body i
//   on j: force at P_j in the ground's axes and in those of body i, moment about P_j        offset A_i^T h
//
// At rest if the snapshot has no velocities. |h| = 0: the direction is lost, the tension reads 0. Units: N, N m.
#pragma once

#include "catena/columns/snapshot.hpp"

namespace catena {

struct SpringLoads {
  double tension = 0, torque = 0, slack = 0;
  Vec2<double> force_on_j, force_on_j_in_i;
  double torque_on_j = 0;
  Vec2<double> offset;
};

SpringLoads spring_loads(const Snapshot& snapshot, int element);

}  // namespace catena
