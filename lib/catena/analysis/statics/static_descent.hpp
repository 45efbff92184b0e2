// Downhill on the constraints: a minimum of the energy in the valley of the start, which must meet the constraints.
//
// Every step follows Newton's direction on the null space of Phi_q, K shifted where its inertia is not a minimum's:
// only the exact K gives the energy's own curvature there, whatever the multipliers, which grow without limit near
// singular positions. A step turns no angle by more than 0.7 rad, is brought back onto the constraints by corrections,
// with the same factors where they serve, and is kept only if the energy fell by a part of what its slope promised;
// else it is halved. Whoever goes on downhill at the limit gets twice the limit: slopes without a bottom show soon. The
// energy never rises, configurations are assembled throughout, and the end is the resting place of the mechanism let go
// gently, which matters where there are several (snap-through, toggles). At a point that is stationary but no minimum
// it stops and says so. Source: Nocedal and Wright, Numerical Optimization, sections 3.1 and 15.6 (reduced gradients).
#pragma once

#include "catena/analysis/statics/static_newton.hpp"

namespace catena {

struct StaticDescentOptions {
  int max_iterations = 200;
  double tolerance = 1e-12;  ///< of the residual force, relative to the largest force
};

/// Iterates q (size coordinates(), assembled) and lambda (rows) in place.
StaticOutcome solve_by_descent(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                               const StaticDescentOptions& options);

/// Brings q back onto the constraints by corrections with the factors at hand, or new ones; the system is left at q.
/// False if that does not converge; q is then of no use.
bool restore_constraints(StaticSystem& system, std::span<double> q);

}  // namespace catena
