// Motions that drivers lead to a place that lies at infinity: a block where the line that carries it becomes parallel
// to its guide, a mechanism whose links would have to be stretched out beyond any length.
//
//   s = a (t* - t)^-p,  p > 0:   rho = s s'' / s'^2 = 1 + 1/p,   t* = t + (p + 1) s' / s''
//
// s: displacement of the fastest body from its given place along its velocity, m; t: s. Near a dead point s stays
// finite, s* - s ~ (t* - t)^(1/2), and rho grows beyond all bounds; a motion that never ends, however fast, has rho = 1
// (exponential) or less. From few length scales away the given place still counts: s is asked to be longer. Singular:
// a body at rest runs nowhere.
#pragma once

#include <optional>
#include <span>

#include "catena/analysis/pose/singular_point.hpp"

namespace catena {

class Evaluator;

/// Displacements, in length scales, and velocities, in parts of their average, of which more grow without bound: that
/// of a dead point grows by 30 over the last thousandth of the time, 1 / sqrt(t* - t).
inline constexpr double far_away = 30;

/// The instant t* at which the motion has reached infinity, if positions, velocities and accelerations at t are those
/// of such a motion; in the direction of time of `last`, and not after it.
std::optional<double> instant_at_infinity(const Evaluator& evaluator, double t, std::span<const double> q,
                                          std::span<const double> qd, std::span<const double> qdd, double last);

/// Makes the point, where w is the combination of equations that velocities grow with, one that lies at infinity.
void put_at_infinity(SingularPoint& point, Evaluator& evaluator, double t, std::span<const double> q,
                     std::span<const double> qd, std::span<const double> w);

}  // namespace catena
