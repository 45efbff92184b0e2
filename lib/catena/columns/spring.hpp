// What a force element exerts now, for the columns of springs, bushings and loads: tension along the line P_i P_j,
// force and torque on i, and force and moment on j.
//
//   tension = F_i . h / |h|, h = r_Pj - r_Pi (positive pulls together)        torque n on body i
//   on j: force at P_j in the ground's axes and in those of body i, moment about P_j        offset A_i^T h
//   power = (Q - Q_0)^T qd, Q_0 without what functions of time and laws of state give: positive drives the mechanism
//
// At rest if the snapshot has no velocities. |h| = 0: the direction is lost, the tension reads 0. Units: N, N m, W.
#pragma once

#include "catena/columns/snapshot.hpp"

namespace catena {

template <class S>
struct BasicSpringLoads {
  S tension{}, torque{}, slack{}, power{};
  Vec2<S> force_on_i;
  Vec2<S> force_on_j, force_on_j_in_i;
  S torque_on_j{};
  Vec2<S> offset;
};
using SpringLoads = BasicSpringLoads<double>;

SpringLoads spring_loads(const Snapshot& snapshot, int element);

}  // namespace catena
