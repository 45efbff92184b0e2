// Kinetic energy and momentum summed over the bodies, for any scalar: what energy.hpp says in numbers, and with
// derivatives where these are dual.
#pragma once

#include "catena/columns/energy.hpp"
#include "catena/elements/force_element.hpp"

namespace catena {

/// `state` gives model(), plan(), frame(plan body) in the ground and twist(plan body).
template <class State, class S = typename State::Scalar>
S kinetic_energy_of(const State& state) {
  const Plan& plan = state.plan();
  S twice{};
  for (int p = 0; p < plan.moving; ++p) {
    const auto& body = state.model().bodies[static_cast<std::size_t>(plan.model_body[static_cast<std::size_t>(p)])];
    const Twist<S> v = state.twist(p);
    twice += body.mass * (v.vx * v.vx + v.vy * v.vy) + body.inertia * v.omega * v.omega;
  }
  return twice * S(0.5);
}

template <class State, class S = typename State::Scalar>
BasicMomentum<S> momentum_of(const State& state) {
  const Plan& plan = state.plan();
  BasicMomentum<S> sum;
  for (int p = 0; p < plan.moving; ++p) {
    const auto& body = state.model().bodies[static_cast<std::size_t>(plan.model_body[static_cast<std::size_t>(p)])];
    const Twist<S> twist = state.twist(p);
    const Vec2<S> v{twist.vx, twist.vy};
    sum.linear += body.mass * v;
    sum.angular += body.mass * cross(state.frame(p).origin(), v) + body.inertia * twist.omega;
  }
  return sum;
}

}  // namespace catena
