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

template <class S>
struct BasicSpringLoads {
  S tension{}, torque{}, slack{};
  Vec2<S> force_on_j, force_on_j_in_i;
  S torque_on_j{};
  Vec2<S> offset;
};
using SpringLoads = BasicSpringLoads<double>;

SpringLoads spring_loads(const Snapshot& snapshot, int element);

}  // namespace catena
