// Static equilibrium by NLopt, for small scenes: sequential quadratic programming (SLSQP), or, where derivatives are
// unreliable, linear models through values alone (COBYLA).
//
// The problem is scaled as for Ipopt: lengths in length scales, angles in rad, energies in the largest applied force
// times the length scale. Both methods are dense: the work of a step grows with the cube of the coordinates.
// Constraints are met to rounding only by the Newton steps that follow; multipliers are those that balance the forces
// best.
// Source: Kraft, ACM TOMS 20 (1994); Powell, DAMTP NA 2007/03; Johnson, The NLopt package.
#pragma once

#include <span>

#include "catena/analysis/minimiser/minimiser.hpp"
#include "catena/analysis/statics/solvers/static_newton.hpp"

namespace catena {

struct StaticNloptOptions {
  int max_evaluations = 3000;
  double tolerance = 1e-11;  ///< of changes of the coordinates: length scales or rad; of constraints
  bool derivatives = true;   ///< false: COBYLA
  /// Larger scenes are refused by the analysis: dense steps would take minutes.
  static constexpr int most_columns = 100;
};

/// Iterates q (size coordinates()) and lambda (rows) in place. StaticEnd::singular where nlopt_is_built_in() is false.
StaticOutcome solve_by_nlopt(StaticSystem& system, std::span<double> q, std::span<double> lambda,
                             const StaticNloptOptions& options);

}  // namespace catena
