// Columns of contacts, stops and joints that rub, for any scalar: what a motion tells of them (ContactLoad), and what
// it leaves out, since it takes no part in the motion.
//
// A State is that of row_values.hpp. Source files alone include it.
#pragma once

#include <cmath>
#include <type_traits>
#include <vector>

#include "catena/columns/reaction.hpp"
#include "catena/columns/touching.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"

namespace catena {

/// Number in the plan of a body of the model, or of the ground.
inline int plan_body(const Plan& plan, int body) {
  return body < 0 ? plan.bodies : plan.plan_body[static_cast<std::size_t>(body)];
}

/// The friction of a joint where mu is zero, which motions do not look at; nullptr for all other elements.
template <class State, class S = typename State::Scalar>
const Friction<S>* idle_friction(const State& state, int element) {
  const ElementRecord& record = state.model().elements[static_cast<std::size_t>(element)];
  const Friction<S>* idle = nullptr;
  with_list(state.model().constraints, record.type, [&](const auto& list) {
    if constexpr (Dry<ElementOf<decltype(list)>>) idle = &list[static_cast<std::size_t>(record.index)].element;
  });
  return idle && !(value_of(idle->mu_static) > 0) && value_of(idle->mu) == 0 ? idle : nullptr;
}

/// What presses there, from the multipliers of the joint, as in friction.hpp.
template <class S>
S idle_press(const Friction<S>& idle, const S* multiplier) {
  using std::abs, std::sqrt;
  const S &a = multiplier[0], &b = multiplier[1];
  if (!idle.turns) return value_of(idle.length) > 0 ? abs(a) + S(2.0) * abs(b) / idle.length : abs(a);
  const S squares = a * a + b * b;
  return value_of(squares) > 0 ? sqrt(squares) : S(0.0);
}

template <class State, class S = typename State::Scalar>
S slip_now(const State& state, int element) {
  if (idle_friction(state, element)) return state.measured(element).d;
  const auto* load = state.contact(element);
  if (!load || !load->glides) return load ? S(load->slip) : S(0.0);
  const auto index = static_cast<std::size_t>(state.model().elements[static_cast<std::size_t>(element)].index);
  const auto& entry = std::get<std::vector<ElementEntry<Contact<S>, S>>>(state.model().constraints)[index];
  const int i = plan_body(state.plan(), entry.i), j = plan_body(state.plan(), entry.j);
  return slip_of(entry.element, state.frame(i), state.frame(j), state.foot(element), state.twist(i), state.twist(j));
}

/// Reactions of contacts and stops in motion: what presses need not be a multiplier, and what rubs is none of theirs.
template <class State, class S = typename State::Scalar>
void take_push(const State& state, int element, BasicElementReactions<S>& reactions) {
  const auto* load = state.contact(element);
  if (!load || (value_of(load->force) == 0 && value_of(load->friction) == 0)) return;
  const ElementRecord& record = state.model().elements[static_cast<std::size_t>(element)];
  with_list(state.model().constraints, record.type, [&](const auto& list) {
    using E = ElementOf<decltype(list)>;
    if constexpr (std::is_same_v<E, Contact<S>> || std::is_same_v<E, Stop<S>>) {
      const auto& entry = list[static_cast<std::size_t>(record.index)];
      const Frame<S> i = state.frame(plan_body(state.plan(), entry.i));
      const Frame<S> j = state.frame(plan_body(state.plan(), entry.j));
      Push<S> push;
      if constexpr (std::is_same_v<E, Contact<S>>) {
        push = push_of(entry.element, i, j, state.foot(element), S(load->force), S(load->friction));
      } else {
        push = push_of(entry.element, i, j, S(load->force));
      }
      const BasicAttachment<S> at = attachment_of(state.model(), element);
      const auto moment = [&](const Vec2<S>& about) { return push.torque + cross(push.place - about, push.force); };
      reactions.joint_x = i.axis(at.axis_i);
      reactions.on_j = {push.force, moment(j.point(at.point_j))};
      reactions.on_i = {-push.force, -moment(i.point(at.point_i))};
    }
  });
}

}  // namespace catena
