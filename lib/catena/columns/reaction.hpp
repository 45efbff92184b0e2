// What a constraint exerts on its bodies, from its multipliers (apps/manual/dynamics.md#reactions).
//
//   force F = -Phi_r^T lambda        torque T = -(Phi_phi^T - (R A s'P)^T Phi_r^T) lambda
//
// per body, about that body's own attachment point P, or about the one place that the element names (the pitch point of
// gears); Phi_r and Phi_phi are the columns of the body's position and angle. The ground's are taken as if it could
// move, so that its reactions come from the same formula. Units: N, N m.
#pragma once

#include "catena/columns/snapshot.hpp"

namespace catena {

template <class S>
struct BasicReaction {
  Vec2<S> force;
  S torque{};
};

template <class S>
struct BasicElementReactions {
  BasicReaction<S> on_i, on_j;  ///< equal for absolute constraints, which act on one body
  Vec2<S> joint_x;              ///< unit vector of the joint's first axis, in the ground frame
  S multiplier[3]{};            ///< of the published equations
};

using Reaction = BasicReaction<double>;
using ElementReactions = BasicElementReactions<double>;

/// Needs snapshot.lambda; the element must have rows in the plan, or be released: then there are none.
ElementReactions element_reactions(const Snapshot& snapshot, int element);

}  // namespace catena
