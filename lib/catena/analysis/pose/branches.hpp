// Branches at a singular configuration: which velocities the mechanism may go on with
// (apps/manual/kinematics.md#singular-configurations).
//
//   Phi_q qd = nu  has the solutions  qd = qd0 + sum_j a_j z_j,  z_j the right null vectors of Phi_q;
//   a motion goes on along qd only if  Phi_q qdd = gamma(q, qd)  can be solved as well:
//   w_i^T gamma(q, qd0 + sum_j a_j z_j) = 0  for all left null vectors w_i
//
// quadratic equations in a, one for one at a simple branch point: two real roots = two branches, a double root = they
// touch, none = the configuration is isolated. With more null vectors the real roots are searched for by Newton's
// method from many starts, up to a nullity of `most_nullity`; above it the nullity and the bodies are all that is said.
// Where the drivers rest (nu = 0) all velocities are zero. Branches are then told apart by the directions in which the
// mechanism moves as soon as the drivers do: the same equations with the speeds that the drivers have a moment later,
// and without their accelerations.
#pragma once

#include <span>

#include "catena/analysis/pose/singular_point.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena {

/// The starts of a search double with every unknown (quadratics.cpp): 2560 at six.
inline constexpr int most_nullity = 6;

enum class Drivers {
  moving,         ///< at the evaluator's time as in the motion
  about_to_move,  ///< they rest, and the evaluator's time is a moment later: tangents are scaled to a speed of 1 of the
                  ///< fastest driver
};

/// The branches at the evaluator's time and the singular configuration q. `along`: the velocity of the motion that came
/// here, empty if it starts here. `threshold`: length below which rows count as dependent, see RankOptions.
SingularPoint find_branches(Evaluator& evaluator, std::span<const double> q, std::span<const double> along,
                            double threshold, Drivers drivers = Drivers::moving);

}  // namespace catena
