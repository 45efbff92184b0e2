// Thresholds that several analyses share: each stands here once, with what it follows from. Those of one mechanism
// stand beside it; whether equations depend on each other is told by linalg/rank/dependence.hpp.
#pragma once

#include <limits>

namespace catena::thresholds {

// Rounding, by what a number went through. A decision that must not depend on rounding takes the first of these that
// its number cannot exceed; where two would do the result is the same, as between them nothing but rounding is found.

/// Of a number that is the sum of up to four products, in parts of the largest of them: a place of a point is such a
/// sum, a force or an energy of two or three terms; each product and each sum rounds by half of epsilon. Positions of
/// the size of the length scale, or rad, cannot be told apart below it.
inline constexpr double few_roundings = 4 * std::numeric_limits<double>::epsilon();

/// Of a sum of some dozen terms that are themselves sums of products, in parts of the largest: residuals of equations,
/// of forces and of moments, entries of a stiffness. No bracket and no refinement gets closer: 1.4e-14.
inline constexpr double sum_rounding = 64 * std::numeric_limits<double>::epsilon();

/// Of what is added up over steps, over a matrix product or along a chain of a few hundred operations: some 450
/// epsilon.
inline constexpr double carried_rounding = 1e-13;

/// Of the solution of linear equations and what follows from it: 1e-15 times the condition of the equations, which is
/// 10^3 and less away from singular positions. Constraints that miss by less, in length scales or rad, hold.
inline constexpr double solved = 1e-12;
inline constexpr double assembled = solved;

/// The same with a condition of 10^5: near singular positions, of regularised equations (kkt_matrix.hpp), of forces
/// that are differences of stiff springs.
inline constexpr double poorly_solved = 1e-10;

/// A part that counts as nothing: equilibria, instants and reactions are found to 1e-11 and better, two digits to
/// spare.
inline constexpr double negligible = 1e-9;

/// A gap below this many length scales (or rad) is closed, and a force below this part of the largest is none.
inline constexpr double closed_gap = negligible, no_force = negligible;

/// Two places, instants, rates or directions that differ by less than this part are the same: configurations are given
/// to some seven digits, and what differences or null vectors tell is good to 1e-7 and better.
inline constexpr double same_value = 1e-6;

/// A place that the scene gives as closed may be open, or reach into the other body, by this part of the length scale
/// (or rad). More contradicts the scene.
inline constexpr double given_depth = same_value;

/// A correction that leaves more than this part of the residual, or of the correction before it, is rounding: the
/// factors are of a neighbouring matrix, and true corrections gain a digit or more.
inline constexpr double least_gain = 0.5;

/// Redundant equations that are missed by more than this, in length scales or rad, contradict the others; the same of
/// rates, relative to the largest: what is less may be rounding, however far from the origin a mechanism is.
inline constexpr double contradiction = 1e-8;

/// A step that must be shortened below this part of itself leads nowhere.
inline constexpr double smallest_factor = 1e-4;

/// Golden section: (3 - sqrt 5) / 2.
inline constexpr double golden_part = 0.381966011250105;

/// Ends of loops that end by themselves. A bracket is as short as rounding of its place after some 50 halvings, or
/// after 80 where the place is near zero; rules that converge faster need fewer.
inline constexpr int most_bisections = 80;

/// Newton's method that contracts by 1/4, the least that steps are accepted with (kinematics/course/step_rules.hpp),
/// brings an error of one length scale to 1e-12 in 20 iterations.
inline constexpr int most_newton_iterations = 25;

/// Corrections with old factors, or of a regularised solution, end where they no longer gain: each that does gains two
/// digits or more.
inline constexpr int most_refinements = 10;

}  // namespace catena::thresholds
