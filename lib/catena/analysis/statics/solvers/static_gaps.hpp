// Newton's method on the equations of static equilibrium with gaps, from anywhere; ends on the exact active set.
//
//   V_q + Phi_q^T lambda - Psi_q^T p = 0,   Phi = 0,   p >= 0,   Psi >= 0,   p Psi = 0
//
// First smoothed: the last three are p Psi = mu, written as the smooth equation
//
//   w + p - sqrt((w - p)^2 + 4 t^2) = 0        w, p: gap and force in the units L and F (F L against angles), mu = t^2
//
// which, unlike the conditions of an interior-point method, full Newton steps may violate on either side. Linearised it
// is one row of the matrix of equilibrium, Psi_q dq - d lambda = ..., d > 0 a compliance (kkt_matrix.hpp): stiff where
// the gap is about to close, soft where it is open, and the inertia says the same as without gaps. K and the limit on
// turns are those of static_newton.hpp; t decreases as fast as the steps become short. Then exactly: the gaps with p >
// w hold as equations, the others not at all; solved to rounding by Newton's method; gaps with p < 0 are released and
// gaps with Psi < 0 added, all at once at first, then, if a set recurs, one by one with the worst first. Source: Chen
// and Harker, SIAM J. Matrix Anal. Appl. 14 (1993), for the smoothing; Nocedal and Wright, Numerical Optimization,
// chapter 16, for active sets.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/statics/solvers/static_newton.hpp"

namespace catena {

/// Which gaps are closed, one entry a gap in the order of Plan::gap_rows.
struct ActiveSet {
  std::vector<char> closed;
  std::vector<char> weak;  ///< touching without a force: rounding decides whether it is closed
  int changes = 0;         ///< sets that were tried beside the first
};

/// Those that are closed and not weak.
std::vector<char> strong_of(const ActiveSet& set);

/// What `judge` says of the configuration q with the weak gaps open, as they may be: they are closed again behind it.
template <class Judge>
auto with_weak_open(StaticSystem& system, std::span<const double> q, const ActiveSet& set, Judge&& judge) {
  if (!system.has_gaps()) return judge();
  system.close_gaps(strong_of(set));
  system.move_to(q);
  auto found = judge();
  system.close_gaps(set.closed);
  system.move_to(q);
  return found;
}

struct StaticGapOptions {
  int max_iterations = 200;  ///< of the smoothed equations
  int first_steps = 80;      ///< of them, until the first smoothing has arrived
  double tolerance = 1e-12;  ///< of gaps in length scales or rad, of their forces relative to the largest one
};

/// Iterates q (size coordinates()) and lambda (rows) in place; `set` is filled. The system is left with the closed gaps
/// as equations.
StaticOutcome solve_with_gaps(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                              const StaticGapOptions& options);

/// The same from a point near a solution, with multipliers: the second part alone.
StaticOutcome finish_with_gaps(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                               const StaticGapOptions& options);

/// All gaps at the system's configuration, m or rad, in the order of Plan::gap_rows.
std::vector<double> gap_values(StaticSystem& system);

}  // namespace catena
