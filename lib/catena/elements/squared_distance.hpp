// Closed forms of h^T h between attachment points of two bodies: shared by relative_distance and coupler.
//
//   (h^T h)_qi = -2 h^T [I, R A_i s'Pi]       (h^T h)_qj = 2 h^T [I, R A_j s'Pj]
//   -((h^T h)_q qd)_q qd = -2 hd^T hd - 2 h^T hdd
//
// Units: m2. The gradient vanishes with h. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/pair_motion.hpp"

namespace catena {

inline void squared_distance_jacobian(const PairGeometry& g, double* entries) {
  entries[0] = -2 * g.h.x;
  entries[1] = -2 * g.h.y;
  entries[2] = -2 * cross(g.arm_i, g.h);
  entries[3] = 2 * g.h.x;
  entries[4] = 2 * g.h.y;
  entries[5] = 2 * cross(g.arm_j, g.h);
}

inline double squared_distance_gamma(const PairMotion& m) { return -2 * (dot(m.hd, m.hd) + dot(m.h, m.hdd)); }

/// Where h^T h has second derivatives: everywhere but between x and y.
inline constexpr std::array squared_distance_hessian_pattern = {
    HessianEntry{0, 0}, HessianEntry{1, 1}, HessianEntry{2, 0}, HessianEntry{2, 1}, HessianEntry{2, 2},
    HessianEntry{3, 0}, HessianEntry{3, 2}, HessianEntry{3, 3}, HessianEntry{4, 1}, HessianEntry{4, 2},
    HessianEntry{4, 4}, HessianEntry{5, 0}, HessianEntry{5, 1}, HessianEntry{5, 2}, HessianEntry{5, 3},
    HessianEntry{5, 4}, HessianEntry{5, 5}};

inline void squared_distance_hessian(const PairGeometry& g, double lambda, double* entries) {
  const double w = 2 * lambda;
  entries[0] = entries[1] = entries[7] = entries[10] = w;
  entries[5] = entries[8] = -w;
  entries[2] = -w * g.arm_i.y;
  entries[3] = w * g.arm_i.x;
  entries[4] = w * (squared_norm(g.arm_i) + dot(g.h, g.arm_i));
  entries[6] = w * g.arm_i.y;
  entries[9] = -w * g.arm_i.x;
  entries[11] = w * g.arm_j.y;
  entries[12] = -w * g.arm_j.x;
  entries[13] = -w * dot(g.arm_i, g.arm_j);
  entries[14] = -w * g.arm_j.y;
  entries[15] = w * g.arm_j.x;
  entries[16] = w * (squared_norm(g.arm_j) - dot(g.h, g.arm_j));
}

}  // namespace catena
