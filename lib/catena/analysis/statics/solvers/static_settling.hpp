// Static equilibrium by settling: the motion with nothing but damping in the metric W = (1, 1, radius^2), followed by
// implicit steps that lengthen as the forces fade, down to Newton's own steps.
//
//   [ K + s W   Phi_q^T ] [ dq      ]   [ Q - Phi_q^T lambda ]        K = -dQ/dq + sum lambda Phi_qq
//   [ Phi_q       -E    ] [ dlambda ] = [ -Phi               ]
//
// s = W / time step, N/m: reduced in proportion to the residual force, raised where a step made it much larger. K is
// the true tangent and need not be symmetric: forces that follow a body's axes have no energy, and this is the solver
// for them. Where there is an energy it is the last method tried: it descends in general, but need not end at a
// minimum. The matrix is that of static_tangent.hpp. One-sided elements
// hold or not as the end of each step asks for (static_settling_gaps.hpp). Singular case: a direction in which nothing
// resists and nothing pulls. Source: Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998), pseudo-transient continuation.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/statics/solvers/static_gaps.hpp"
#include "catena/analysis/statics/solvers/static_newton.hpp"

namespace catena {

struct StaticSettlingOptions {
  int max_iterations = 1000;
  double tolerance = 1e-12;  ///< of the residual force, relative to the largest force
};

/// E of the equations times the largest stiffness, of other unsymmetric tangents too: constraints yield by less than
/// what stiffnesses are rounded to.
inline constexpr double settling_regularisation = 1e-11;

/// Iterates q (size coordinates()) and lambda (rows) in place; no gaps.
StaticOutcome solve_by_settling(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                                const StaticSettlingOptions& options);

/// The same with gaps: `set` is filled, the system left with the closed ones as equations.
StaticOutcome solve_by_settling(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                                const StaticSettlingOptions& options);

}  // namespace catena
