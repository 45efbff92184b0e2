// Closed forms of p = v^T h: the part of the vector between two attachment points that lies along a direction of body
// i.
//
//   v = A_i v'       p_qi = [-v^T, v x (h + A_i s'Pi)]       p_qj = [v^T, -(v x A_j s'Pj)]
//   -(p_q qd)_q qd = phid_i^2 v^T h - 2 phid_i (v x hd) - v^T hdd                                (x: the plane cross)
//
// With R v' for v' it is the part across the direction. Shared by displacement, slot, translational, rack_pinion; v' is
// a unit vector, hence p in m. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/pair_motion.hpp"

namespace catena {

/// p_q, the six columns of i and j; `v` = A_i v'.
inline void projection_jacobian(const PairGeometry& g, const Vec2<double>& v, double* entries) {
  entries[0] = -v.x;
  entries[1] = -v.y;
  entries[2] = cross(v, g.h + g.arm_i);
  entries[3] = v.x;
  entries[4] = v.y;
  entries[5] = -cross(v, g.arm_j);
}

inline double projection_gamma(const PairMotion& m, const Vec2<double>& v, double omega_i) {
  return omega_i * (omega_i * dot(v, m.h) - 2 * cross(v, m.hd)) - dot(v, m.hdd);
}

/// Where p has second derivatives.
inline constexpr std::array projection_hessian_pattern = {HessianEntry{2, 0}, HessianEntry{2, 1}, HessianEntry{2, 2},
                                                          HessianEntry{3, 2}, HessianEntry{4, 2}, HessianEntry{5, 2},
                                                          HessianEntry{5, 5}};

/// Those second derivatives. As p is linear in v, that of several rows is that of the sum of their directions, each
/// multiplied by its lambda.
inline void projection_hessian(const PairGeometry& g, const Vec2<double>& v, double* entries) {
  entries[0] = v.y;
  entries[1] = -v.x;
  entries[2] = -dot(v, g.h + g.arm_i);
  entries[3] = -v.y;
  entries[4] = v.x;
  entries[5] = dot(v, g.arm_j);
  entries[6] = -dot(v, g.arm_j);
}

}  // namespace catena
