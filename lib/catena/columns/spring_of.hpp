// What one force element exerts, for any scalar: what spring.hpp says in numbers, and with derivatives where these are
// dual.
#pragma once

#include "catena/columns/spring.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"

namespace catena {

/// `state` gives model(), plan(), time(), frame(plan body) in the ground, twist(plan body) and law_value(number).
template <class State, class S = typename State::Scalar>
BasicSpringLoads<S> spring_loads_of(const State& state, int element) {
  const BasicModel<S>& model = state.model();
  const Plan& plan = state.plan();
  const auto plan_body = [&](int body) {
    return body < 0 ? plan.bodies : plan.plan_body[static_cast<std::size_t>(body)];
  };
  const ElementRecord& record = model.elements[static_cast<std::size_t>(element)];
  BasicSpringLoads<S> loads;
  with_list(model.forces, record.type, [&](const auto& list) {
    const auto& entry = list[static_cast<std::size_t>(record.index)];
    if constexpr (Sharing<ElementOf<decltype(list)>>) {
      loads.slack = rope_slack<S>(list, record.index, [&](int body) { return state.frame(plan_body(body)); });
      if (value_of(loads.slack) < 0) loads.tension = -entry.element.k * loads.slack;
      return;
    }
    constexpr int functions = ElementOf<decltype(list)>::functions;
    S f[functions + 1] = {};  // one more, so that it is never empty
    for (std::size_t k = 0; k < entry.values.size(); ++k) {
      const auto& value = entry.values[k];
      if (value.law >= 0) {
        f[k] = state.law_value(value.law);
      } else {
        f[k] = value.function < 0
                   ? value.constant
                   : model.functions[static_cast<std::size_t>(value.function)].evaluate(value_of(state.time())).f;
      }
    }
    const Frame<S> i = state.frame(plan_body(entry.i)), j = state.frame(plan_body(entry.j));
    const Twist<S> u = state.twist(plan_body(entry.i)), v = state.twist(plan_body(entry.j));
    Wrench<S> on_i, on_j;
    entry.element.force(ForceArguments<S>{i, j, u, v, f, {}}, on_i, on_j);
    const BasicAttachment<S> attachment = attachment_of(entry);
    const Vec2<S> h = j.point(attachment.point_j) - i.point(attachment.point_i);
    // Where the points meet the direction is lost.
    if (value_of(squared_norm(h)) > 0) loads.tension = dot(Vec2<S>{on_i.fx, on_i.fy}, h) / norm(h);
    loads.torque = on_i.moment;
    loads.force_on_i = {on_i.fx, on_i.fy};
    if constexpr (functions > 0) {
      const S none[functions + 1] = {};
      Wrench<S> own_i, own_j;
      entry.element.force(ForceArguments<S>{i, j, u, v, none, {}}, own_i, own_j);
      const auto power = [](const Wrench<S>& all, const Wrench<S>& own, const Twist<S>& twist) {
        return (all.fx - own.fx) * twist.vx + (all.fy - own.fy) * twist.vy + (all.moment - own.moment) * twist.omega;
      };
      loads.power = power(on_i, own_i, u) + power(on_j, own_j, v);
    }
    const auto in_i = [&](const Vec2<S>& vector) { return i.to_local(vector); };
    loads.force_on_j = {on_j.fx, on_j.fy};
    loads.force_on_j_in_i = in_i(loads.force_on_j);
    loads.torque_on_j = on_j.moment - cross(j.axis(attachment.point_j), loads.force_on_j);
    loads.offset = in_i(h);
    if constexpr (requires { entry.element.slack(i, j); }) {
      loads.slack = entry.element.slack(i, j);
    }
  });
  return loads;
}

}  // namespace catena
