// The way that free particles make while what drives them changes: the length of a scene in which nothing else gives
// one, of particles given at one place, with neither joints nor arms.
//
//   way = |v| T + max |a| T^2 / 2        T = min(horizon, max |a| / max |a'|, 1 / sqrt(|da/dq|), 1 / |da/dqd|)
//
// v: the velocities at the start, m/s; a: accelerations at the start's place over the run, m/s^2, and a' their rate
// there; da/dq and da/dqd by differences over the way itself. A weight or a constant force has T = horizon: the way of
// the whole run; F sin(omega t) has F / (2 m omega^2), half of its amplitude. Less than the motion makes in the end:
// what is compared with it becomes no coarser. Singular: where nothing moves there is none.
#pragma once

#include <span>

#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {

/// At (t, q, qd), plan order; `last`: the end of the run, s. 0 where nothing moves. The evaluator is left elsewhere.
double way_of_motion(EquationsOfMotion& equations, double t, std::span<const double> q, std::span<const double> qd,
                     double last);

}  // namespace catena
