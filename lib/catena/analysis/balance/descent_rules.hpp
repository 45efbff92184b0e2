// The rules of descent on the constraints (statics/solvers/static_descent.hpp) and of its certificate, which single
// searches and searches in lanes (batch/lane_equilibrium.hpp) keep alike: what they find is then the same.
#pragma once

namespace catena::descent {

/// Of a search, where not more are asked for.
inline constexpr int most_steps = 200;
/// Of one step, rad, unless the limit has doubled.
inline constexpr double largest_turn = 0.7;
/// Of one step of Newton's method, rad, as elements are not linear.
inline constexpr double newton_turn = 1;
/// Where a step of Newton's method with a positive K is shorter, length scales or rad, K is the same at its end: one
/// more correction with the same factors reaches rounding.
inline constexpr double last_step = 1e-4;
/// Shifts of K: the first relative to rounding of the largest stiffness or to force / extent, the last relative to the
/// largest stiffness. Between them a soft support of a stiff part must be distinguished from no support. A search
/// begins with this part of the shift of the step before.
inline constexpr double first_of_rounding = 1e-15, first_of_force = 1e-6, largest_shift = 1e6, part_of_last = 1.0 / 16;
/// Growth of the shift where the inertia is not that of a minimum.
inline constexpr double stiffening = 32;
inline constexpr double sufficient_decrease = 1e-4;
/// The energy is a sum of large terms: a change below this part of them is rounding.
inline constexpr double noise_part = 1e-14;
/// A step shorter than this, length scales or rad, ends the search.
inline constexpr double polishing_change = 1e-6;
/// Constraints are met to this, in length scales or rad, between steps: by so many corrections with the same factors,
/// each of which leaves no more than a part of the residual, and as many with new ones where these fail. A longer
/// correction, length scales or rad, is none.
inline constexpr double restored = 1e-10, remaining_part = 0.7, longest_correction = 10;
inline constexpr int most_corrections = 12;
/// Steps of Newton's method that may remain where forces are known only to rounding of stiff springs, length scales or
/// rad.
inline constexpr double rounded_change = 1e-9;
/// Modes softer than this part of the stiffest are tested for rounding by a certificate: far above any rounding.
inline constexpr double suspicious_part = 1e-6;

}  // namespace catena::descent
