// What contacts and stops exert in motion, and the slip of contacts: from places, velocities, and the loads found
// there.
//
//   contact   P = r_Pj - R n,  F = N n + T t on j at P,  -F on i          t = A_i p'/|p'|, n: unit normal, free side
//             slip = t^T (v_j(P) - v_i(P))            v_k(P) = rd_k + phid_k R (P - r_k)
//   elastic   T acts along the slide of slide_law.hpp: F = N n + f T t, and the torque R b (1 - f) T about P,
//             f = (1 - R b kappa) / (1 - delta kappa), delta: of the point of body j to the left of the curve
//   stop      F = +-N v, or +-N h/|h|, at P_j, or the torque +-N, on j, and their opposite on i: + at its lower bound
//
// R (before n): radius of the disc, m; N, T: what presses and what rubs, N (of angles N m). The foot of the point of
// body j (point_on_curve.hpp) gives p'; one Newton step carries its derivatives by parameters. Singular where the foot
// is, and where a bounded distance vanishes. Units: m, N, m/s. Source: Haug, section 3.4.
#pragma once

#include "catena/elements/constraints/contact.hpp"
#include "catena/elements/constraints/stop.hpp"
#include "catena/elements/force_element.hpp"

namespace catena {

/// What a one-sided element exerts on body j, in the ground frame; the opposite on body i, at the same place.
template <class S>
struct Push {
  Vec2<S> force, place;
  S torque{};
};

/// Where the material touches, and the direction of the curve there. `stretch`: of the way along the curve against that
/// of body j, 1 but where an elastic contact is pressed in.
template <class S>
struct Touch {
  Vec2<S> place, along, normal;
  S stretch{1.0};
};

template <class S>
Touch<S> touch_of(const Contact<S>& contact, const Frame<S>& i, const Frame<S>& j, const CurvePlace& foot) {
  const Vec2<S> x = i.to_local(j.point(contact.s_j) - i.origin());
  S s(foot.s_i);
  const CurvePoint<S> near = contact.curve.evaluate(s);
  const Vec2<S> off = near.p - x;
  s -= dot(off, near.d1) / S(value_of(squared_norm(near.d1)) + value_of(dot(off, near.d2)));
  const CurvePoint<S> c = contact.curve.evaluate(s);
  const S size = norm(c.d1), curvature = cross(c.d1, c.d2) / (size * size * size), apart = cross(c.d1, x - c.p) / size;
  const Vec2<S> along = (S(1.0) / size) * i.axis(c.d1);
  const Vec2<S> normal = S(contact.free_side()) * perpendicular(along);
  const S arm = S(contact.free_side()) * contact.radius;
  return {j.point(contact.s_j) - contact.radius * normal, along, normal,
          (S(1.0) - arm * curvature) / (S(1.0) - apart * curvature)};
}

template <class S>
S slip_of(const Contact<S>& contact, const Frame<S>& i, const Frame<S>& j, const CurvePlace& foot, const Twist<S>& v_i,
          const Twist<S>& v_j) {
  const Touch<S> touch = touch_of(contact, i, j, foot);
  const auto velocity = [&](const Frame<S>& body, const Twist<S>& v) {
    return Vec2<S>{v.vx, v.vy} + v.omega * perpendicular(touch.place - body.origin());
  };
  return dot(touch.along, velocity(j, v_j) - velocity(i, v_i));
}

template <class S>
Push<S> push_of(const Contact<S>& contact, const Frame<S>& i, const Frame<S>& j, const CurvePlace& foot,
                const S& pressing, const S& rubbing) {
  const Touch<S> touch = touch_of(contact, i, j, foot);
  const S along = touch.stretch * rubbing, arm = S(contact.free_side()) * contact.radius;
  return {pressing * touch.normal + along * touch.along, touch.place, arm * (rubbing - along)};
}

template <class S>
Push<S> push_of(const Stop<S>& stop, const Frame<S>& i, const Frame<S>& j, const S& pressing) {
  const S u = stop.value(i, j);
  const S push = value_of(u - stop.min) < value_of(stop.max - u) ? pressing : -pressing;
  const Vec2<S> place = j.point(stop.s_j);
  if (stop.quantity == StopQuantity::angle) return {{}, place, push};
  if (stop.quantity == StopQuantity::slide) return {push * i.axis(stop.axis_i), place};
  const Vec2<S> h = place - i.point(stop.s_i);
  return {value_of(squared_norm(h)) > 0 ? (push / norm(h)) * h : Vec2<S>{}, place};
}

}  // namespace catena
