// The reactions of one element from its part of Phi_q, for any scalar: what reaction.hpp says in numbers, and with
// derivatives where these are dual.
#pragma once

#include "catena/columns/reaction.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"

namespace catena {
namespace detail {

/// Reaction on the body whose three columns begin at `first`, about the end of `arm` = A s'P.
template <class S, class Jacobian>
BasicReaction<S> reaction_on(const Jacobian& jacobian, const S* multiplier, int first, const Vec2<S>& arm) {
  S load[3] = {};  // Phi_q^T lambda of this body
  for (int row = 0; row < jacobian.rows; ++row) {
    for (int k = 0; k < 3; ++k) load[k] += jacobian.entries[6 * row + first + k] * multiplier[row];
  }
  const Vec2<S> force{-load[0], -load[1]};
  return {force, -load[2] - dot(perpendicular(arm), force)};
}

}  // namespace detail

/// `state` gives model() and frame(plan body) in the ground; `lambda` are the multipliers of the element's rows, in the
/// solver's scale; `jacobian` is an ElementJacobian in the state's scalar.
template <class State, class Jacobian, class S = typename State::Scalar>
BasicElementReactions<S> reactions_of(const State& state, int element, const Jacobian& jacobian, const S* lambda) {
  const BasicModel<S>& model = state.model();
  const BasicAttachment<S> attachment = attachment_of(model, element);
  const Frame<S> frame_i = state.frame(jacobian.body_i);
  const Frame<S> frame_j = state.frame(jacobian.bodies == 1 ? state.plan().bodies : jacobian.body_j);
  BasicElementReactions<S> result;
  for (int row = 0; row < jacobian.rows; ++row) result.multiplier[row] = S(jacobian.scale) * lambda[row];
  result.joint_x = frame_i.axis(attachment.axis_i);
  // From each body's origin to where the reaction on it is reported.
  Vec2<S> arm_i = frame_i.axis(attachment.point_i), arm_j = frame_j.axis(attachment.point_j);
  const ElementRecord& record = model.elements[static_cast<std::size_t>(element)];
  with_list(model.constraints, record.type, [&](const auto& list) {
    const auto& joint = list[static_cast<std::size_t>(record.index)].element;
    if constexpr (requires { joint.reaction_point(frame_i, frame_j); }) {
      const Vec2<S> place = joint.reaction_point(frame_i, frame_j);
      arm_i = place - frame_i.origin();
      arm_j = place - frame_j.origin();
    }
  });
  result.on_i = detail::reaction_on<S>(jacobian, result.multiplier, 0, arm_i);
  result.on_j = jacobian.bodies == 1 ? result.on_i : detail::reaction_on<S>(jacobian, result.multiplier, 3, arm_j);
  return result;
}

}  // namespace catena
