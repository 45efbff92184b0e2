// Newton's method on the equations of static equilibrium, from anywhere: the start need not meet the constraints.
//
//   [ K  Phi_q^T ] [ dq      ]   [ -V_q ]
//   [ Phi_q  0   ] [ lambda+ ] = [ -Phi ]
//
// Far from the solution K is convex (StaticSystem::fill), so that every step descends on the null space of Phi_q; steps
// are full, only turned angles are clipped to 1 rad, and there is no merit function: constraints of a long chain are
// met by the next step, since they are linear in positions. Near the solution K is exact as long as its inertia is that
// of a minimum; the iteration then converges quadratically and ends with a correction by the present factors. At a
// stationary point that is no minimum it stops with a report. It need not find the minimum nearest to the start
// (StaticDescent does).
// Measured (apps/manual/numerics.md#hanging-chains): 700 starts of seven kinds at N = 100: all converged, 6 to 21
// iterations.
#pragma once

#include <span>

#include "catena/analysis/statics/solvers/static_steps.hpp"

namespace catena {

struct StaticNewtonOptions {
  int max_iterations = 60;
  double tolerance = 1e-12;  ///< of the residual force, relative to the largest force
  bool warm = false;         ///< lambda holds multipliers of a nearby solution
  bool stationary = false;   ///< any stationary point will do: never leave the exact K near the solution
};

/// Iterates q (size coordinates()) and lambda (rows) in place.
StaticOutcome solve_by_newton(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                              const StaticNewtonOptions& options);

/// The multipliers that balance the applied forces best: least squares in the weights (1, 1, radius^2), constraints met
/// to first order. One factorization. False if there is none. `exact`: to rounding, as needed if the exact K is used
/// next: K of a mechanism in balance at any position is a difference of large terms that contain lambda.
bool first_multipliers(StaticSystem& system, std::span<double> lambda, bool exact = false);

/// Multipliers, and the lengths that springs will have once their tensions are those that balance the loads best (see
/// StaticSystem::foresee): springs begin without tension. One factorization. False if there is none.
bool first_tensions(StaticSystem& system, std::span<double> lambda);

/// Newton steps with the factors at hand until nothing is gained any more; where forces or constraints are then not met
/// to `tolerance`, with those of a K that resists every motion a little.
void polish(StaticSystem& system, std::span<double> q, std::span<double> lambda, StaticOutcome& outcome,
            double tolerance);

}  // namespace catena
