// What steps of a driven motion keep to, one motion at a time (kinematics_march.cpp) as many in lanes
// (batch/lane_motion.hpp). Angles in rad, other lengths in length scales.
#pragma once

namespace catena::step_rules {

/// A prediction may be off by this angle: the constraints are linear in positions, those of points bend by half its
/// square.
inline constexpr double largest_turn = 0.1;
/// A correction may be this part of the one before: Newton's iteration then stays where it contracts.
inline constexpr double largest_contraction = 0.25;
/// With that an error of one length scale comes to 1e-12 in 20 iterations.
inline constexpr int most_iterations = 25;
/// A ratio of successive corrections above this asks for new factors.
inline constexpr double poor_contraction = 0.1;
/// No body may turn further in a step: a singular configuration in between could be missed.
inline constexpr double longest_step = 0.5;
/// A given configuration is taken as near to the assembled one if Newton's first correction is at most this large, and
/// every further one at most `largest_contraction` of the one before.
inline constexpr double nearby = 0.1;

/// A block whose determinant falls below this part of its value one step before may pass through a singular matrix:
/// this holds if it vanishes linearly, for any position of steps of equal length about that instant. (Its smallest
/// pivot may be another one than that which vanishes.)
inline constexpr double sudden_part = 0.6;
/// The same by extrapolation from the step before: at least this part must be left of it.
inline constexpr double remaining_part = 0.3;

/// The prediction of a node of a bridge (kinematics_bridge.hpp) may be off by this part of the bridge's motion: whether
/// nodes lie on one branch is tested by the constraints along the polynomial.
inline constexpr double node_allowance = 0.2;

}  // namespace catena::step_rules
