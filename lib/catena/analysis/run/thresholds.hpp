// Thresholds that several analyses share: each stands here once, with what it follows from. Those of one mechanism
// stand beside it; whether equations depend on each other is told by linalg/rank/dependence.hpp.
#pragma once

#include <limits>

namespace catena::thresholds {

// A name stands for a meaning, not for a size: a tolerance, a step, a bound or a margin that happens to have one of
// these values has its own name and reason where it is used.

/// Rounding of a number that is the sum of up to four products, in parts of the largest of them: a place of a point is
/// such a sum, a force or an energy of two or three terms; each product and each sum rounds by half of epsilon.
inline constexpr double few_roundings = 4 * std::numeric_limits<double>::epsilon();

/// Positions, in length scales or rad, that cannot be told from rounding: some four epsilon of coordinates that are of
/// the size of the length scale.
inline constexpr double position_rounding = 1e-15;

/// Rounding of a sum of some dozen terms that are themselves sums of products, in parts of the largest: residuals of
/// equations, of forces and of moments, entries of a stiffness.
inline constexpr double sum_rounding = 64 * std::numeric_limits<double>::epsilon();

/// Rounding of what is added up over steps, over a matrix product or along a chain of a few hundred operations: some
/// 450 epsilon.
inline constexpr double carried_rounding = 1e-13;

/// Rounding of the solution of linear equations: 1e-15 times their condition, which is 10^3 and less away from singular
/// positions.
inline constexpr double solved = 1e-12;
/// Constraints that miss by less, in length scales or rad, hold: assembly ends with what solutions of linear equations
/// leave.
inline constexpr double assembled = solved;

/// A gap below this many length scales (or rad) is closed, and a force below this part of the largest is none:
/// equilibria and the instants of impacts are found to 1e-11 and better, two digits are to spare.
inline constexpr double closed_gap = 1e-9, no_force = 1e-9;

/// Two places, velocities, gradients or directions that differ by less than this part are the same: configurations are
/// given to some seven digits, and what motions, differences or null vectors tell is good to 1e-7 and better.
inline constexpr double same_value = 1e-6;

/// Derivatives of a column by a parameter, of which this part of the column's size is left, are rounding, whatever the
/// size of the parameter up to 1e9.
inline constexpr double no_derivative = 1e-11;

/// Two instants that are nearer to each other than this part of the stretch of time that they lie in are one: they are
/// found to rounding on motions that are known to some eight digits.
inline constexpr double same_instant = 1e-9;

/// A velocity that changes at an instant by less than this part of the largest does not jump, nor does an acceleration
/// or a column by less than this part of its size: steps keep velocities, and tables and laws meet their ends, to about
/// 1e-12 of that.
inline constexpr double no_jump = 1e-9;

/// Two instants, or functions of time, whose rates differ by less than this part move together: rates are good to 1e-8
/// and better.
inline constexpr double same_rate = 1e-6;

/// The product of two vectors, or of the sizes of its terms, that is below this part of the product of their lengths is
/// none: modes and null vectors come from equations that are solved to 1e-12.
inline constexpr double no_overlap = 1e-9;

/// Inverse iterations for a null vector: each gains the ratio of the smallest eigenvalue to the next.
inline constexpr int null_vector_steps = 4;

/// A body may turn at most this far, rad, in one step of a search that follows linearised equations: beyond it they are
/// useless, and linkages change their assembly mode.
inline constexpr double largest_turn = 0.5;

/// A place that the scene gives as closed may be open, or reach into the other body, by this part of the length scale
/// (or rad): configurations are given to some seven digits. More contradicts the scene.
inline constexpr double given_depth = 1e-6;

/// Differences for a rate are taken over this part of a stretch first, and halved until two of them agree to the second
/// part, at most so often: the last one is over 2^-18 of the stretch, where rounding of values is 1e-11 of the rate.
inline constexpr double first_difference = 1.0 / 32, settled_difference = 1e-11;
inline constexpr int most_differences = 14;

/// A correction that leaves more than this part of the residual, or of the correction before it, is rounding: the
/// factors are of a neighbouring matrix, and true corrections gain a digit or more.
inline constexpr double least_gain = 0.5;

/// Redundant equations that are missed by more than this, in length scales or rad, contradict the others; the same of
/// rates, relative to the largest: what is less may be rounding, however far from the origin a mechanism is.
inline constexpr double contradiction = 1e-8;

/// A step that must be shortened below this part of itself leads nowhere.
inline constexpr double smallest_factor = 1e-4;

/// What bodies of a driven motion may move, rad or length scales, from where their powers were looked at to where they
/// are next. Gauss's rule of four points is off by h^8 f^(8) 4!^4 / (9 8!^3) of the mean of f: 4e-13 where a power of
/// two periods a turn, f^(8) = 2^8 f, is followed over this.
inline constexpr double driven_stretch = 0.2;

/// Golden section: (3 - sqrt 5) / 2.
inline constexpr double golden_part = 0.381966011250105;

/// End of a loop that ends by itself. A bracket is as short as rounding of its place after some 50 halvings, or
/// after 80 where the place is near zero; rules that converge faster need fewer.
inline constexpr int most_bisections = 80;

}  // namespace catena::thresholds
