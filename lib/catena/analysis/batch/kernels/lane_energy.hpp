// The potential energy in packs of designs, its first and second derivatives, and those of constraints times their
// multipliers. Part of the kernels (lane_static_kernel.hpp).
//
//   V = -sum m g.r + sum of the forces' potentials      K_ij = D_i D_j (V_ij + sum lambda Phi_ij)
//
// A spring or a cable with tension f along h:  V_h = t h, V_hh = t I + (k - t) u u^T,  t = f/l, u = h/l;  t = k where
// its ends meet. Other forces from dual numbers. Second derivatives of constraints from Taylor series along pairs of
// coordinates a, b: 2 Phi_ab = Phi''(a + b) - Phi''(a) - Phi''(b); a pin's are its arms. Units: J, N, N m, N/m.
#pragma once

#include "catena/analysis/batch/kernels/lane_loads.hpp"
#include "catena/analysis/batch/kernels/lane_static_code.hpp"

namespace catena {

template <class V>
class LaneEnergy : protected LaneLoads<V> {
 protected:
  using Base = LaneLoads<V>;
  using Base::at;
  using Base::code_;
  using Base::frame;
  using Base::job_;
  using Base::put;
  using Base::unit_;
  using typename Base::Mask;
  using typename Base::P;

  LaneEnergy(const LaneStaticJob& job, int lane) : Base(job.equations, lane), rest_(job) {
    rest_.inverse_arm += lane, rest_.origin += lane, rest_.length += lane;
    rest_.mask += lane, rest_.shift += lane, rest_.by_weights += lane;
    rest_.gradient += lane, rest_.change += lane, rest_.next_lambda += lane;
    rest_.stiffness += lane, rest_.reduced += lane, rest_.reflector += lane, rest_.factor += lane;
    rest_.diagonal += lane, rest_.lower += lane, rest_.work += lane, rest_.told += lane;
  }

  /// Phi, Phi_q, V_q and the energy at q.
  void look();
  /// K.
  void fill();
  void tell(LaneRest what, const P& value) const { put(rest_.told, what, value); }
  P arm(int column) const { return at(rest_.inverse_arm, column); }

  LaneStaticJob rest_;  // its arrays begin at the lanes of this pack

 private:
  static constexpr int none = -1;
  struct Sums {
    P energy, dead;
  };
  int column(int body, int k) const { return body < code_.moving ? 3 * body + k : none; }
  void add_gradient(int column, const P& value) const {
    if (column != none) put(rest_.gradient, column, at(rest_.gradient, column) + value);
  }
  void add_stiffness(int row, int column, const P& value) const {
    if (row == none || column == none) return;
    const int place = rest_.columns * row + column;
    put(rest_.stiffness, place, at(rest_.stiffness, place) + arm(row) * arm(column) * value);
  }
  /// On both bodies of an element, number k of six.
  int column_of(int body_i, int body_j, int k) const { return k < 3 ? column(body_i, k) : column(body_j, k - 3); }

  struct Line {
    typename Base::Ends ends;
    P tension, stiffness, energy;  ///< the first one by the length
    Vec2<P> direction;             ///< 0 where the ends meet
  };
  template <class E>
  Line line(const LaneForce& f) const;
  template <class E>
  void pull(const LaneForce& f, Sums& sums) const;
  template <class E>
  void bend(const LaneForce& f) const;
  void begin(Sums& sums) const;
  template <class E>
  void act(const LaneForce& f, Sums& sums) const;
  template <class E>
  void resist(const LaneForce& f) const;
  template <class E>
  void constrain(const LaneElement& e) const;
  P number(const LaneForce& f, int k) const { return at(job_.field, f.field + k); }
  template <class E>
  static constexpr bool pulls = std::is_same_v<E, SpringDamper<P>> || std::is_same_v<E, ElasticCable<P>>;
  /// At rest it exerts nothing.
  template <class E>
  static constexpr bool rests = std::is_same_v<E, JointDamper<P>>;
};

// Weights.
template <class V>
void LaneEnergy<V>::begin(Sums& sums) const {
  const P gx = at(job_.field, code_.loads.gravity), gy = at(job_.field, code_.loads.gravity + 1);
  for (int b = 0; b < code_.moving; ++b) {
    const P mass = at(job_.field, code_.loads.masses + 2 * b);
    const P fx = mass * gx, fy = mass * gy;
    put(rest_.gradient, 3 * b, -fx);
    put(rest_.gradient, 3 * b + 1, -fy);
    put(rest_.gradient, 3 * b + 2, P(0));
    sums.energy = sums.energy - (fx * at(job_.q, 3 * b) + fy * at(job_.q, 3 * b + 1));
    sums.dead = larger(sums.dead, larger(abs(fx), abs(fy)));
  }
}

template <class V>
template <class E>
typename LaneEnergy<V>::Line LaneEnergy<V>::line(const LaneForce& f) const {
  constexpr bool is_spring = std::is_same_v<E, SpringDamper<P>>;
  const P length = number(f, is_spring ? 6 : 4);
  Line result;
  result.stiffness = number(f, is_spring ? 4 : 5);
  result.ends = this->ends(f);
  const Vec2<P>& h = result.ends.h;
  const P square = squared_norm(h), k = result.stiffness;
  const Mask apart = square > P(0);
  const P l = sqrt(select(apart, square, P(1))), stretch = l - length;
  result.direction = {select(apart, h.x / l, P(0)), select(apart, h.y / l, P(0))};
  if constexpr (is_spring) {
    const P actuator = at(job_.function, f.function);
    result.tension = select(apart, (k * stretch + actuator) / l, k);
    result.energy =
        select(apart, P(0.5) * k * stretch * stretch + actuator * l, P(0.5) * k * (square + length * length));
  } else {
    const Mask taut = apart && stretch > P(0);
    result.tension = select(taut, k * stretch / l, P(0));
    result.energy = select(taut, P(0.5) * k * stretch * stretch, P(0));
    result.stiffness = select(taut, k, P(0));
  }
  return result;
}

template <class V>
template <class E>
void LaneEnergy<V>::pull(const LaneForce& f, Sums& sums) const {
  const Line s = line<E>(f);
  const Vec2<P> force = s.tension * s.ends.h;
  sums.energy = sums.energy + s.energy;
  const P on[] = {-force.x, -force.y, -cross(s.ends.arm_i, force), force.x, force.y, cross(s.ends.arm_j, force)};
  for (int k = 0; k < 6; ++k) add_gradient(column_of(f.body_i, f.body_j, k), on[k]);
}

template <class V>
template <class E>
void LaneEnergy<V>::bend(const LaneForce& f) const {
  const Line s = line<E>(f);
  const P along = s.stiffness - s.tension;
  const Vec2<P>&u = s.direction, &i = s.ends.arm_i, &j = s.ends.arm_j;
  // dh by the six coordinates.
  const Vec2<P> by[] = {{P(-1), P(0)}, {P(0), P(-1)}, {i.y, -i.x}, {P(1), P(0)}, {P(0), P(1)}, {-j.y, j.x}};
  for (int a = 0; a < 6; ++a) {
    const P part = along * dot(u, by[a]);
    for (int b = 0; b < 6; ++b)
      add_stiffness(column_of(f.body_i, f.body_j, a), column_of(f.body_i, f.body_j, b),
                    s.tension * dot(by[a], by[b]) + part * dot(u, by[b]));
  }
  const int turn_i = column(f.body_i, 2), turn_j = column(f.body_j, 2);
  add_stiffness(turn_i, turn_i, s.tension * dot(s.ends.h, i));
  add_stiffness(turn_j, turn_j, -(s.tension * dot(s.ends.h, j)));
}

template <class V>
template <class E>
void LaneEnergy<V>::act(const LaneForce& f, Sums& sums) const {
  const Frame<P> i = frame(f.body_i), j = frame(f.body_j);
  const Twist<P> rest;
  P values[E::functions + 1];
  for (int k = 0; k < E::functions; ++k) values[k] = at(job_.function, f.function + 3 * k);
  const ForceArguments<P> arguments{i, j, rest, rest, values, {}};
  const E element = this->template element<E>(f);
  Wrench<P> on_i, on_j;
  element.force(arguments, on_i, on_j);
  sums.energy = sums.energy + element.potential(arguments);
  const P on[] = {on_i.fx, on_i.fy, on_i.moment, on_j.fx, on_j.fy, on_j.moment};
  for (int k = 0; k < 3 * E::bodies; ++k) {
    const int c = column_of(f.body_i, f.body_j, k);
    add_gradient(c, -on[k]);
    if constexpr (std::is_same_v<E, PointForce<P>> || std::is_same_v<E, Torque<P>>) {
      if (c != none) sums.dead = larger(sums.dead, arm(c) * abs(on[k]));
    }
  }
}

template <class V>
template <class E>
void LaneEnergy<V>::resist(const LaneForce& f) const {
  using D = Dual<P, 6>;
  const Frame<D> i = seed<P, 6>(frame(f.body_i), 0), j = seed<P, 6>(frame(f.body_j), 3);
  const Twist<D> rest;
  D values[E::functions + 1];
  for (int k = 0; k < E::functions; ++k) values[k] = D(at(job_.function, f.function + 3 * k));
  Wrench<D> on_i, on_j;
  this->template element<E>(f).force(ForceArguments<D>{i, j, rest, rest, values, {}}, on_i, on_j);
  const D* const on[] = {&on_i.fx, &on_i.fy, &on_i.moment, &on_j.fx, &on_j.fy, &on_j.moment};
  for (int a = 0; a < 3 * E::bodies; ++a) {
    for (int b = 0; b < 3 * E::bodies; ++b) {
      const auto r = static_cast<std::size_t>(a), c = static_cast<std::size_t>(b);
      add_stiffness(column_of(f.body_i, f.body_j, a), column_of(f.body_i, f.body_j, b),
                    P(-0.5) * (on[a]->d[c] + on[b]->d[r]));
    }
  }
}

template <class V>
template <class E>
void LaneEnergy<V>::constrain(const LaneElement& e) const {
  constexpr int coordinates = 3 * E::bodies;
  if constexpr (std::is_same_v<E, Revolute<P>>) {
    const E pin = this->template element<E>(e);
    const Vec2<P> force{at(job_.lambda, e.row), at(job_.lambda, e.row + 1)};
    const int turn_i = column(e.body_i, 2), turn_j = column(e.body_j, 2);
    add_stiffness(turn_i, turn_i, dot(force, frame(e.body_i).axis(pin.s_i)));
    add_stiffness(turn_j, turn_j, -dot(force, frame(e.body_j).axis(pin.s_j)));
  } else if constexpr (varying_entries<E>() > 0) {
    const auto along = [&](int a, int b) {
      P rate[6];
      rate[a] = P(1);
      if (b >= 0) rate[b] = P(1);
      P rows[E::rows], sum(0);
      this->template second<E>(e, {rate[0], rate[1], rate[2]}, {rate[3], rate[4], rate[5]}, rows);
      for (int r = 0; r < E::rows; ++r) sum = sum + at(job_.lambda, e.row + r) * rows[r];
      return sum;
    };
    P own[coordinates];
    for (int a = 0; a < coordinates; ++a) own[a] = along(a, none);
    for (int a = 0; a < coordinates; ++a) {
      const int row = column_of(e.body_i, e.body_j, a);
      add_stiffness(row, row, own[a]);
      for (int b = 0; b < a; ++b) {
        const int other = column_of(e.body_i, e.body_j, b);
        if (row == none || other == none) continue;
        const P mixed = P(0.5) * (along(a, b) - own[a] - own[b]);
        add_stiffness(row, other, mixed);
        add_stiffness(other, row, mixed);
      }
    }
  }
}

template <class V>
void LaneEnergy<V>::look() {
  this->set_frames();
  tell(rest_gap, this->template equations<true>());
  Sums sums{P(0), P(0)};
  begin(sums);
  this->for_each_force([&]<class E>(const LaneForce& f) {
    if constexpr (pulls<E>) {
      pull<E>(f, sums);
    } else if constexpr (!rests<E>) {
      act<E>(f, sums);
    }
  });
  tell(rest_energy, sums.energy);
  tell(rest_dead, sums.dead);
  P extent = at(rest_.length, 0), load(0);
  for (int c = 0; c < rest_.columns; ++c) {
    load = larger(load, arm(c) * abs(at(rest_.gradient, c)));
    if (c % 3 != 2) extent = larger(extent, abs(at(job_.q, c) - at(rest_.origin, 2 * (c / 3) + c % 3)));
  }
  tell(rest_extent, extent);
  tell(rest_load, load);
}

template <class V>
void LaneEnergy<V>::fill() {
  for (int k = 0; k < rest_.columns * rest_.columns; ++k) put(rest_.stiffness, k, P(0));
  this->for_each_force([&]<class E>(const LaneForce& f) {
    if constexpr (pulls<E>) {
      bend<E>(f);
    } else if constexpr (!rests<E>) {
      resist<E>(f);
    }
  });
  this->for_each_element([&]<class E>(const LaneElement& e) { constrain<E>(e); });
}

}  // namespace catena
