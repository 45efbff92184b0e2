// Static equilibrium by Ipopt's interior-point method with MUMPS: exact gradient, Jacobian and Hessian of the
// Lagrangian, their patterns from the plan.
//
// Ipopt's tolerance is absolute, so it is given a scaled problem: lengths in extents L of the scene, angles in rad,
// forces in units of the sum F of all applied forces, energies in F L. Equations that depend on others at the start are
// left out (their multipliers are zero): an interior-point method needs independent equations. One-sided equations
// become bounds. It does not distinguish a minimum from another stationary point (the certificate does), and need not
// find the minimum nearest to the start. One problem at a time runs in a process: MUMPS shares its workspace. Source:
// Waechter, Biegler, Math. Program. 106 (2006).
#pragma once

#include <span>

#include "catena/analysis/statics/solvers/static_newton.hpp"

namespace catena {

struct StaticIpoptOptions {
  int max_iterations = 500;
  double tolerance = 1e-11;  ///< of residual forces relative to the largest force, of constraints to the length
  bool warm = false;         ///< q and lambda are near a solution
  bool verbose = false;      ///< Ipopt's log to standard error
};

/// Whether the library was built with Ipopt (CATENA_WITH_IPOPT).
bool ipopt_is_built_in();

/// Iterates q (size coordinates()) and lambda (rows) in place. StaticEnd::singular where ipopt_is_built_in() is false.
StaticOutcome solve_by_ipopt(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                             const StaticIpoptOptions& options);

}  // namespace catena
