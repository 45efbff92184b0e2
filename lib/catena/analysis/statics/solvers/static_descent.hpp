// Descent on the constraints: finds the minimum of the energy that is reached downhill from the start, which must meet
// the constraints.
//
// Every step follows Newton's direction on the null space of Phi_q, K shifted where its inertia is not that of a
// minimum: only the exact K gives the curvature of the energy there for all multipliers, which grow without bound near
// singular positions. A step turns no angle by more than 0.7 rad, is brought back onto the constraints by corrections,
// with the same factors where they serve, and is accepted only if the energy on the constraints, V + lambda^T Phi to
// first order, decreases by a part of the decrease that its slope predicts; else it is halved. The limit on steps
// doubles while successive steps reach it, so that an energy without a minimum is recognised after few steps. The
// energy never rises, configurations are assembled throughout, and the result is the place at which the mechanism comes
// to rest when released slowly, which matters where there are several equilibria (snap-through, toggles). At a
// stationary point that is no minimum the search stops with a report. Source: Nocedal and Wright, Numerical
// Optimization, sections 3.1 and 15.6 (reduced gradients).
#pragma once

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/statics/solvers/static_newton.hpp"

namespace catena {

struct StaticDescentOptions {
  int max_iterations = descent::most_steps;
  double tolerance = 1e-12;  ///< of the residual force, relative to the largest force
};

/// Iterates q (size coordinates(), assembled) and lambda (rows) in place.
StaticOutcome solve_by_descent(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                               const StaticDescentOptions& options);

/// Returns q to the constraints by corrections with the present factors, or new ones; the system is left at q. False if
/// that does not converge; q is then undefined.
bool restore_constraints(StaticSystem& system, std::span<double> q);

}  // namespace catena
