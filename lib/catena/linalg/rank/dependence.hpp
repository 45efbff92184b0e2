// What is done at which dependence of the constraints: one table for all uses.
//
// Measure: d, the sine of the angle between a row of Phi_q and the span of the others (of those eliminated before it),
// in the metric in use. It is proportional to the distance from a singular position; rounding of accelerations is
// eps / d^3, of velocities eps / d^2, of places eps / d. Three methods tell it:
//
//   pivots     the smallest ratio of a pivot of S = Phi_q W^-1 Phi_q^T to the diagonal entry that it came from is d^2
//              (ConstraintSolver::smallest_pivot_ratio). Very unequal masses make all ratios small: along a motion
//              they are compared with the usual one (stage_ratios.hpp), which is marked "compared"
//   ranks      QR of scaled rows tells d itself, to 1e-12 and better (rank_revealing.hpp)
//   condition  the ratio of the least to the largest pivot of a driven mechanism's Phi_q is d, roughly (Factorization)
//
// Sources: apps/manual/numerics.md#singular-passages, apps/manual/numerics.md#regularisation.
#pragma once

namespace catena::dependence {

// Pivot ratios d^2 of ConstraintSolver.

/// Rows as near as this cannot be told from dependent ones by pivots: below, `regularisation` of the diagonal is added,
/// far below the accuracy of a row's own products and enough for a factorization. With both, refinement gains two
/// digits a round at least.
inline constexpr double formal = 1e-10, regularisation = 1e-12;
/// So many times as much, and without what is added as well, before rows count as independent again.
inline constexpr double clearly_more = 10;
/// Rounding of a pivot, in parts of the largest diagonal of a row like it: smaller ratios say nothing beside unequal
/// masses.
inline constexpr double rounding_of_pivots = 1e-14;
/// Below: multipliers have lost five digits and are refined once. Below the second, where bodies are light to turn
/// (light_turns.hpp): steps of bars on couplers, J = 1e-6 ... 1e-3 m a^2, at a tolerance of 1e-12 stalled from ratios
/// of 3e-4 on, and nowhere since.
inline constexpr double refined = 1e-5, refined_if_light = 1e-2;

// Pivot ratios along a motion.

/// Above: rows are independent, no rank analysis is needed; rounding leaves ratios of 1e-16, and assembled places that
/// miss the constraints by 1e-12 ones of 1e-24. Below: accelerations are wrong by 2e-4 and more, or formal, and the
/// limit of the motion is sought in their place.
inline constexpr double independent = 1e-8;
/// No step ends below, or below a limit that follows from its tolerance (compared); accelerations lose ratio^1.5 there.
inline constexpr double end_of_step = 1e-7, lost_digits = 2e-11;
/// Below, a sine of 0.03: where no step can be made a dead point is sought; steps of a large tolerance, and pivots of
/// unequal masses, tell the sine no better. Whether there is one is told by the place that is found.
inline constexpr double worth_a_search = 1e-3;
/// Below: a singular configuration is told as the likely cause where no step can be made.
inline constexpr double likely_cause = 1e-6;
/// Below, where rounding is a thousand times that elsewhere: stages are projected and steps balanced (compared), Adams
/// methods leave the steps to Runge-Kutta (compared), and what is interpolated is checked by itself.
inline constexpr double singular_passage = 1e-2;
/// What small ratios are to others of the motion beside a singular position: light parts make all of them small.
inline constexpr double unusual = 0.3;
/// From here on Adams methods take over again (compared).
inline constexpr double behind_passage = 2e-2;
/// Below: all methods project their steps, of which the balance says what drivers do, and a step may pass a place where
/// branches meet (compared) ...
inline constexpr double near_passage = 0.1;
/// ... until the ratio is larger than this; steps of Adams methods that fail below it are left to Runge-Kutta.
inline constexpr double clear_of_passage = 0.2;

// Sines d from ranks.

/// Rows follow from others: between the rounding of assembled places (1e-12) and the least angles that still determine
/// a motion.
inline constexpr double follows = 1e-10;
/// The same at places that are known no more exactly: given or found starts, dead points.
inline constexpr double follows_at_start = 1e-7;
/// The same at instants that steps come near to: accelerations taken from the limit there are wrong by as much.
inline constexpr double follows_nearby = 3e-4;
/// The same of dead points that end a motion: steps end where velocities have grown a thousandfold.
inline constexpr double follows_at_end = 1e-3;

// Condition of a driven mechanism.

/// Above: all rows are independent without doubt, ranks need not be taken.
inline constexpr double clearly_regular = 1e-9;
/// Below: the factors may be those of an earlier iterate, and the pivots are looked at.
inline constexpr double suspicious = 1e-4;
/// Above: old factors are kept, which hide a change of the determinant's sign. Fallen to this part: equations are
/// chosen again.
inline constexpr double far_from_singular = 1e-2, fallen = 1e-2;

}  // namespace catena::dependence
