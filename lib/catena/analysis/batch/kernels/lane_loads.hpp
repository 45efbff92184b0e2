// Loads in packs of designs: applied forces and inertia, and the multipliers that they ask for. Part of the kernels
// (lane_kernel.hpp).
//
//   Phi_q^T lambda = Q - M qdd
//
// Forces are those of the elements themselves, but for springs and cables, which lose their direction where their ends
// meet: a spring is then k h, as spring_damper.hpp has it. Where a mechanism has others besides, all of them are given
// by evaluators (lane_evaluators.hpp). Units: N, N m, kg, kg m^2.
#pragma once

#include "catena/analysis/batch/kernels/lane_solution.hpp"
#include "catena/elements/forces/bushing.hpp"
#include "catena/elements/forces/joint_damper.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/elements/forces/torsion_spring.hpp"

namespace catena {

template <class V>
class LaneLoads : protected LaneSolution<V> {
 protected:
  using Base = LaneSolution<V>;
  using Base::at;
  using Base::Base;
  using Base::code_;
  using Base::frame;
  using Base::job_;
  using Base::put;
  using Base::twist;
  using typename Base::Mask;
  using typename Base::P;

  void find_loads();
  /// The ends of a spring or a cable, whose first four numbers are their places.
  struct Ends {
    Vec2<P> arm_i, arm_j, h;
  };
  P number(const LaneForce& f, int k) const { return at(job_.field, f.field + k); }
  Ends ends(const LaneForce& f) const;
  template <class F>
  void for_each_force(F&& f) const;

 private:
  void add(int body, const Wrench<P>& load);
  void pull(const LaneForce& f, const Ends& ends, const Vec2<P>& force);
  void begin();
  void spring(const LaneForce& f);
  void cable(const LaneForce& f);
  template <class E>
  void exert(const LaneForce& f);
};

template <class V>
typename LaneLoads<V>::Ends LaneLoads<V>::ends(const LaneForce& f) const {
  const Frame<P> i = frame(f.body_i), j = frame(f.body_j);
  const Vec2<P> arm_i = i.axis(Vec2<P>{number(f, 0), number(f, 1)});
  const Vec2<P> arm_j = j.axis(Vec2<P>{number(f, 2), number(f, 3)});
  return {arm_i, arm_j, {(j.x + arm_j.x) - (i.x + arm_i.x), (j.y + arm_j.y) - (i.y + arm_i.y)}};
}

template <class V>
void LaneLoads<V>::add(int body, const Wrench<P>& load) {
  if (body >= code_.moving) return;
  put(job_.load, 3 * body, at(job_.load, 3 * body) + load.fx);
  put(job_.load, 3 * body + 1, at(job_.load, 3 * body + 1) + load.fy);
  put(job_.load, 3 * body + 2, at(job_.load, 3 * body + 2) + load.moment);
}

template <class V>
void LaneLoads<V>::pull(const LaneForce& f, const Ends& ends, const Vec2<P>& force) {
  Wrench<P> on_i, on_j;
  add_force_at(ends.arm_i, force, on_i);
  add_force_at(ends.arm_j, -force, on_j);
  add(f.body_i, on_i);
  add(f.body_j, on_j);
}

// Weight, inertia and what is given.
template <class V>
void LaneLoads<V>::begin() {
  const P gx = at(job_.field, code_.loads.gravity), gy = at(job_.field, code_.loads.gravity + 1);
  for (int b = 0; b < code_.moving; ++b) {
    const P mass = at(job_.field, code_.loads.masses + 2 * b), inertia = at(job_.field, code_.loads.masses + 2 * b + 1);
    put(job_.load, 3 * b, at(job_.applied, 3 * b) + mass * (gx - at(job_.qdd, 3 * b)));
    put(job_.load, 3 * b + 1, at(job_.applied, 3 * b + 1) + mass * (gy - at(job_.qdd, 3 * b + 1)));
    put(job_.load, 3 * b + 2, at(job_.applied, 3 * b + 2) - inertia * at(job_.qdd, 3 * b + 2));
  }
}

template <class V>
void LaneLoads<V>::spring(const LaneForce& f) {
  const P k = number(f, 4), c = number(f, 5), length = number(f, 6);
  const Twist<P> u = twist(f.body_i), v = twist(f.body_j);
  const Ends e = ends(f);
  const Vec2<P> rate{(v.vx - v.omega * e.arm_j.y) - (u.vx - u.omega * e.arm_i.y),
                     (v.vy + v.omega * e.arm_j.x) - (u.vy + u.omega * e.arm_i.x)};
  const P square = squared_norm(e.h);
  const Mask apart = square > P(0);
  const P l = sqrt(select(apart, square, P(1)));
  const P tension = k * (l - length) + c * (dot(e.h, rate) / l) + at(job_.function, f.function);
  pull(f, e, select(apart, tension / l, k) * e.h);
}

template <class V>
void LaneLoads<V>::cable(const LaneForce& f) {
  const P length = number(f, 4), k = number(f, 5);
  const Ends e = ends(f);
  const P l = sqrt(squared_norm(e.h)), stretch = l - length;
  const Mask taut = stretch > P(0);
  pull(f, e, select(taut, k * stretch / select(taut, l, P(1)), P(0)) * e.h);
}

template <class V>
template <class E>
void LaneLoads<V>::exert(const LaneForce& f) {
  if constexpr (std::is_same_v<E, SpringDamper<P>>) {
    spring(f);
  } else if constexpr (std::is_same_v<E, ElasticCable<P>>) {
    cable(f);
  } else {
    const Frame<P> i = frame(f.body_i), j = frame(f.body_j);
    const Twist<P> u = twist(f.body_i), v = twist(f.body_j);
    P values[E::functions + 1];
    for (int k = 0; k < E::functions; ++k) values[k] = at(job_.function, f.function + 3 * k);
    Wrench<P> on_i, on_j;
    this->template element<E>(f).force(ForceArguments<P>{i, j, u, v, values, {}}, on_i, on_j);
    add(f.body_i, on_i);
    if constexpr (E::bodies == 2) add(f.body_j, on_j);
  }
}

// Calls f(force type, force) for all forces, type after type.
template <class V>
template <class F>
void LaneLoads<V>::for_each_force(F&& visit) const {
  const LaneForce* f = code_.loads.force;
  for (const LaneForces *of_type = code_.loads.of_type, *last = of_type + code_.loads.types; of_type != last;
       ++of_type) {
    const LaneForce* const end = f + of_type->count;
    switch (of_type->type) {
#define CATENA_LANE_VISIT(Type)                                           \
  case Type##_in_lanes:                                                   \
    for (; f != end; ++f) visit.template operator()<catena::Type<P>>(*f); \
    break;
      CATENA_LANE_FORCES(CATENA_LANE_VISIT)
#undef CATENA_LANE_VISIT
      case lane_force_types:
        break;
    }
  }
}

template <class V>
void LaneLoads<V>::find_loads() {
  begin();
  for_each_force([&]<class E>(const LaneForce& f) { exert<E>(f); });
  for (const LaneUnknown* u = code_.unknown; u != code_.unknown + code_.rows; ++u)
    P::load(job_.load + u->coordinate).store(job_.right + u->place);
  this->solve_transposed();
  for (int r = 0; r < code_.rows; ++r) put(job_.lambda, r, at(job_.right, r));
}

}  // namespace catena
