// Finds the conflicting constraints where not all of them can be met.
//
//   min over q of  sum_k sqrt(|Phi_k|^2 + eps^2)        Phi_k: the rows of constraint k, in length scales or rad
//
// A sum of sizes, unlike one of squares, leaves as few constraints unmet as it can: one wrong length among others that
// agree with each other ends as the one misfit, where least squares would spread it over all. Where constraints cannot
// be distinguished, as the pins of one loop that does not close, all of them share the misfit. The constraints in
// conflict with the unmet ones are those that carry multipliers at the minimum. Found by damped Gauss-Newton steps on
// squares weighted with 1 / sqrt(|Phi_k|^2 + eps^2), eps falling, from the configuration given: a local minimum.
// Source: iteratively reweighted least squares, e.g. D. O'Leary (1990).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/constraint_solver.hpp"

namespace catena {

struct Misfit {
  int element = -1;
  double size = 0;  ///< length of the vector of its residuals: m, or rad
  bool angle = false;
};

struct Conflict {
  std::vector<Misfit> unmet;  ///< the constraints that remain unmet, the worst first, at most ten, in published units
  std::vector<int> elements;  ///< these and the constraints they are at odds with, ascending
};

/// Moves `q` (plan order) to where the sum is least. `solver` holds the weights in which the length of a step is
/// measured; inverse weights of zero belong to coordinates that may not move.
Conflict find_conflict(Evaluator& evaluator, ConstraintSolver& solver, std::span<double> q);

/// "revolute "B" misses by 0.12 m, ..." in one line, worst first.
std::string describe_misfits(const Model& model, std::span<const Misfit> misfits);
/// The likely cause, in words: drivers that contradict each other, a loop that does not close.
/// Bodies with `hold`, which may be the reason why constraints are not met; empty if there are none.
std::string describe_held(const Model& model);
std::string describe_cause(const Model& model, const Conflict& conflict);

}  // namespace catena
