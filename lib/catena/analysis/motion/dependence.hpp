// What is done at which dependence of the constraints: one table for equations of motion and integrators.
//
// Measure: the smallest ratio of a pivot of S = Phi_q M^-1 Phi_q^T to the diagonal entry that it came from,
// d^2, the squared sine of the angle between a row and the span of those eliminated before it, in the metric M^-1
// (EquationsOfMotion::smallest_pivot_ratio). d is proportional to the distance from a singular position, rounding of
// accelerations to eps / d^3, of velocities to eps / d^2, of places to eps / d. Very unequal masses make all ratios
// small: along a motion ratios are compared with the usual one (stage_ratios.hpp), which is marked "compared".
// Sources: apps/manual/numerics.md#singular-passages.
#pragma once

namespace catena::dependence {

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

}  // namespace catena::dependence
