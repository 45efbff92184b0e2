// The equations of a mechanism in packs of designs: frames, Phi, Phi_q, nu, gamma. Part of the kernels
// (lane_kernel.hpp).
//
//   gamma = -d2Phi/dt2 along q + qd t      nu = -dPhi/dt at rest      both from
//   the Taylor series of phi, as the derived operations of
//   assembly/constraint_operations.hpp; Phi_q from dual numbers. Pins, gears
//   and belts have their closed forms (revolute.hpp, rolling_pair.hpp). Contacts of curves are evaluated outside of the
//   kernels, lane by lane (lane_searches.hpp).
#pragma once

#include <numbers>

#include "catena/analysis/batch/kernels/lane_code.hpp"
#include "catena/analysis/batch/kernels/lane_pack.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/displacement.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/relative_x.hpp"
#include "catena/elements/constraints/relative_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/elements/force_element.hpp"
#include "catena/elements/list.hpp"

namespace catena {

template <class V>
class LaneEquations {
 protected:
  using P = Pack<V>;
  using Mask = typename P::Mask;

  LaneEquations(const LaneJob& job, int lane)
      : job_(job), code_(*job.code), unit_(P::load(job.unit + lane)), group_(job), lane_(lane) {
    // One by one: an object whose members have their addresses taken would be kept in memory.
    job_.field += lane, job_.function += lane, job_.frame += lane;
    job_.q += lane, job_.qd += lane, job_.qdd += lane, job_.applied += lane, job_.load += lane, job_.lambda += lane;
    job_.turned += lane;
    job_.matrix += lane, job_.right += lane, job_.tail += lane, job_.exchange += lane;
    job_.found.converged += lane, job_.found.first_size += lane, job_.found.first_turn += lane,
        job_.found.contraction += lane;
    job_.found.residual += lane, job_.found.margin += lane;
  }

  static P at(const double* base, int number) { return P::load(base + lane_count * number); }
  static void put(double* base, int number, const P& value) { value.store(base + lane_count * number); }

  static constexpr double small_turn = 1e-4;  // d^4 / 24 = 4e-18, d^5 / 120 = 8e-23
  void set_frames();
  /// The same where no angle has changed by more than small_turn since.
  void turn_frames();
  /// The residuals into the right-hand side, and, where it is wanted, Phi_q into the matrix. Returns their largest, rad
  /// or length scales.
  template <bool with_jacobian>
  P equations();
  void nu();
  void gamma();

  Frame<P> frame(int body) const {
    const double* const f = job_.frame + 5 * lane_count * body;
    return {at(f, 0), at(f, 1), at(f, 2), at(f, 3), at(f, 4)};
  }
  /// `Code` is a LaneElement or a LaneForce.
  template <class E, class Code>
  E element(const Code& e) const {
    E result;
    int k = e.field;
    std::apply([&](const auto&... field) { (load(result, field, e.choice, k), ...); }, E::fields());
    if constexpr (requires { result.angle; }) result.angle = at(job_.field, k++);
    if constexpr (requires { result.constant; }) result.constant = at(job_.field, k++);
    return result;
  }

  /// The rates of a body.
  Twist<P> twist(int body) const {
    if (body >= code_.moving) return {};
    return {at(job_.qd, 3 * body), at(job_.qd, 3 * body + 1), at(job_.qd, 3 * body + 2)};
  }
  P scale(const LaneElement& e) const { return e.scale < 0 ? P(1) : at(job_.field, e.scale); }
  template <class F>
  void for_each_element(F&& f) const;
  /// d2Phi of an element's rows along rates of its bodies, c and the bodies' accelerations at zero.
  template <class E>
  void second(const LaneElement& e, const Twist<P>& u, const Twist<P>& v, P* rows) const;

  LaneJob job_;  // its arrays begin at the lanes of this pack
  LaneCode code_;
  P unit_;

 private:
  const LaneJob& group_;  // of all lanes, this pack's from lane_ on
  int lane_;

  void search(LaneSearch what) const {
    if (code_.searched_rows > 0) group_.search(group_, what, lane_, P::size);
  }
  template <class E, class Field>
  void load(E& element, const Field& field, int choice, int& k) const {
    if constexpr (requires { field.member; }) {
      auto& member = element.*field.member;
      using Member = std::remove_cvref_t<decltype(member)>;
      if constexpr (std::is_same_v<Member, bool> || std::is_same_v<Member, int>) {
        member = static_cast<Member>(choice);
      } else if constexpr (requires { member.x; }) {
        member = {at(job_.field, k), at(job_.field, k + 1)};
        k += 2;
      } else {
        member = at(job_.field, k++);
      }
    }
  }
  Taylor<P> value(const LaneElement& e) const {
    if (e.function < 0) return {};
    return {at(job_.function, e.function), at(job_.function, e.function + 1), at(job_.function, e.function + 2)};
  }
  template <class E>
  void put_residual(const LaneElement& e, P* rows, P& largest) const;
  template <class E>
  void pin(const LaneElement& e, P* rows) const;
  template <class E>
  void differentiate(const LaneElement& e, P* rows) const;
  // Of gears and belts, whose angle of the line of centres has whole turns taken out of it:
  template <class E>
  static constexpr bool rolls = std::is_same_v<E, Gear<P>> || std::is_same_v<E, Belt<P>>;
  struct Rolling {
    P a, b;  ///< of rolling_pair.hpp
    Vec2<P> arm_i, arm_j, h;
    P square;  ///< h^T h
  };
  template <class E>
  Rolling rolling(const E& pair, const Frame<P>& i, const Frame<P>& j) const;
  template <class E>
  P roll(const LaneElement& e) const;
  template <class E>
  void roll_jacobian(const LaneElement& e) const;
  template <class E>
  P roll_gamma(const LaneElement& e, const Twist<P>& u, const Twist<P>& v) const;
  Vec2<P> turned(const Vec2<P>& v, const P& omega) const { return {-(omega * v.y), omega * v.x}; }
};

template <class V>
void LaneEquations<V>::set_frames() {
  for (int b = 0; b < code_.moving; ++b) {
    const double* const q = job_.q + 3 * lane_count * b;
    double* const f = job_.frame + 5 * lane_count * b;
    const P angle = at(q, 2);
    P c, s;
    sincos(angle, c, s);
    put(f, 0, at(q, 0));
    put(f, 1, at(q, 1));
    put(f, 2, angle);
    put(f, 3, c);
    put(f, 4, s);
  }
}

// cos and sin of a sum, those of the change by their series: what is left out is below 1e-17.
template <class V>
void LaneEquations<V>::turn_frames() {
  for (int b = 0; b < code_.moving; ++b) {
    const double* const q = job_.q + 3 * lane_count * b;
    double* const f = job_.frame + 5 * lane_count * b;
    const P angle = at(q, 2), d = angle - at(f, 2), c = at(f, 3), s = at(f, 4);
    const P square = d * d, sine = d - d * square * P(1.0 / 6), versine = P(0.5) * square;
    put(f, 0, at(q, 0));
    put(f, 1, at(q, 1));
    put(f, 2, angle);
    put(f, 3, c - (s * sine + c * versine));
    put(f, 4, s + (c * sine - s * versine));
  }
}

// Calls f(element type, element) for all elements, type after type.
template <class V>
template <class F>
void LaneEquations<V>::for_each_element(F&& f) const {
  const LaneElement* e = code_.element;
  for (const LaneElements *of_type = code_.of_type, *last = of_type + code_.types; of_type != last; ++of_type) {
    const LaneElement* const end = e + of_type->count;
    switch (of_type->type) {
#define CATENA_LANE_VISIT(Type)                                       \
  case Type##_in_lanes:                                               \
    for (; e != end; ++e) f.template operator()<catena::Type<P>>(*e); \
    break;
      CATENA_LANE_ELEMENTS(CATENA_LANE_VISIT)
#undef CATENA_LANE_VISIT
      case lane_types:
        break;
    }
  }
}

template <class V>
template <class E>
void LaneEquations<V>::put_residual(const LaneElement& e, P* rows, P& largest) const {
  for (int r = 0; r < E::rows; ++r) {
    if constexpr (HasSquaredValue<E>) rows[r] = rows[r] * scale(e);
    put(job_.right, e.row + r, rows[r]);
    largest = larger(largest, abs(rows[r]) * (row_unit<E>(r) == UnitKind::angle ? P(1) : unit_));
  }
}

template <class V>
template <class E>
void LaneEquations<V>::pin(const LaneElement& e, P* rows) const {
  const E pin = element<E>(e);
  const Frame<P> i = frame(e.body_i), j = frame(e.body_j);
  const Vec2<P> arm_i = i.axis(pin.s_i), arm_j = j.axis(pin.s_j);
  rows[0] = (j.x + arm_j.x) - (i.x + arm_i.x);
  rows[1] = (j.y + arm_j.y) - (i.y + arm_i.y);
  const int* const place = code_.place + e.first_place;
  arm_i.y.store(job_.matrix + place[0]);
  (-arm_j.y).store(job_.matrix + place[1]);
  (-arm_i.x).store(job_.matrix + place[2]);
  arm_j.x.store(job_.matrix + place[3]);
}

template <class V>
template <class E>
void LaneEquations<V>::differentiate(const LaneElement& e, P* values) const {
  constexpr int columns = 3 * E::bodies;
  using D = Dual<P, columns>;
  constexpr auto pattern = jacobian_pattern<E>();
  const Frame<D> i = seed<P, columns>(frame(e.body_i), 0);
  Frame<D> j;
  if constexpr (E::bodies == 2) j = seed<P, columns>(frame(e.body_j), 3);
  D rows[E::rows];
  element<E>(e).phi(Arguments<D>{i, j, D(value(e).f), {}}, rows);
  for (int r = 0; r < E::rows; ++r) values[r] = rows[r].v;
  const int* place = code_.place + e.first_place;
  for (std::size_t n = 0; n < pattern.size(); ++n) {
    if (pattern[n] != Entry::varying) continue;
    P entry = rows[n / columns].d[n % columns];
    if constexpr (HasSquaredValue<E>) entry = entry * scale(e);
    entry.store(job_.matrix + *place++);
  }
}

template <class V>
template <class E>
typename LaneEquations<V>::Rolling LaneEquations<V>::rolling(const E& pair, const Frame<P>& i,
                                                             const Frame<P>& j) const {
  bool is_alike;  // the wheels turn alike
  if constexpr (std::is_same_v<E, Gear<P>>) {
    is_alike = pair.internal;
  } else {
    is_alike = !pair.crossed;
  }
  Rolling r;
  r.a = pair.radius_i;
  r.b = is_alike ? -pair.radius_j : pair.radius_j;
  r.arm_i = i.axis(pair.s_i), r.arm_j = j.axis(pair.s_j);
  r.h = {(j.x - i.x) + (r.arm_j.x - r.arm_i.x), (j.y - i.y) + (r.arm_j.y - r.arm_i.y)};
  r.square = squared_norm(r.h);
  return r;
}

template <class V>
template <class E>
typename LaneEquations<V>::P LaneEquations<V>::roll(const LaneElement& e) const {
  const E pair = element<E>(e);
  const Frame<P> i = frame(e.body_i), j = frame(e.body_j);
  const Rolling r = rolling(pair, i, j);
  const P d = r.a + r.b, period = P(2 * std::numbers::pi) * d;
  const P principal = (r.a * i.phi + r.b * j.phi - d * atan2(r.h.y, r.h.x)) - pair.constant;
  const P turns = round(principal / select(abs(period) > P(0), period, P(1)));
  return principal - turns * period;
}

template <class V>
template <class E>
void LaneEquations<V>::roll_jacobian(const LaneElement& e) const {
  const Rolling r = rolling(element<E>(e), frame(e.body_i), frame(e.body_j));
  const P part = (r.a + r.b) / r.square;
  const Vec2<P> g{-(part * r.h.y), part * r.h.x};
  const P entries[] = {g.x, g.y, r.a + cross(r.arm_i, g), -g.x, -g.y, r.b - cross(r.arm_j, g)};
  const int* const place = code_.place + e.first_place;
  for (int k = 0; k < 6; ++k) entries[k].store(job_.matrix + place[k]);
}

template <class V>
template <class E>
typename LaneEquations<V>::P LaneEquations<V>::roll_gamma(const LaneElement& e, const Twist<P>& u,
                                                          const Twist<P>& v) const {
  const Rolling r = rolling(element<E>(e), frame(e.body_i), frame(e.body_j));
  const P w_i = u.omega, w_j = v.omega;
  const Vec2<P> apart{v.vx - u.vx, v.vy - u.vy};
  const Vec2<P> hd = (apart + turned(r.arm_j, w_j)) - turned(r.arm_i, w_i);
  const Vec2<P> hdd = (w_i * w_i) * r.arm_i - (w_j * w_j) * r.arm_j;
  const P turning = cross(r.h, hd) / r.square;
  return (r.a + r.b) * (cross(r.h, hdd) - P(2) * turning * dot(r.h, hd)) / r.square;
}

template <class V>
template <bool with_jacobian>
typename LaneEquations<V>::P LaneEquations<V>::equations() {
  P largest(0);
  for_each_element([&]<class E>(const LaneElement& e) {
    P rows[E::rows];
    if constexpr (rolls<E>) {
      rows[0] = roll<E>(e);
      if constexpr (with_jacobian) roll_jacobian<E>(e);
    } else if constexpr (!with_jacobian || varying_entries<E>() == 0) {
      const Frame<P> i = frame(e.body_i), j = E::bodies == 2 ? frame(e.body_j) : Frame<P>{};
      element<E>(e).phi(Arguments<P>{i, j, value(e).f, {}}, rows);
    } else if constexpr (std::is_same_v<E, Revolute<P>>) {
      pin<E>(e, rows);
    } else {
      differentiate<E>(e, rows);
    }
    put_residual<E>(e, rows, largest);
  });
  search(with_jacobian ? LaneSearch::jacobian : LaneSearch::residual);
  for (int k = 0; k < code_.searched_rows; ++k)
    largest = larger(largest, abs(at(job_.right, code_.searched[k])) * unit_);
  return largest;
}

template <class V>
void LaneEquations<V>::nu() {
  for (int r = 0; r < code_.rows; ++r) put(job_.right, r, P(0));
  for_each_element([&]<class E>(const LaneElement& e) {
    if constexpr (E::functions > 0) {
      if (!e.timed) return;
      const P zero(0);
      const auto i = moving(frame(e.body_i), zero, zero, zero);
      auto j = i;
      if constexpr (E::bodies == 2) j = moving(frame(e.body_j), zero, zero, zero);
      Taylor<P> rows[E::rows];
      element<E>(e).phi(Arguments<Taylor<P>>{i, j, value(e), {}}, rows);
      for (int r = 0; r < E::rows; ++r) put(job_.right, e.row + r, -(scale(e) * rows[r].d));
    }
  });
}

template <class V>
void LaneEquations<V>::gamma() {
  const auto moved = [&](int body) {
    const P zero(0);
    if (body >= code_.moving) return moving(frame(body), zero, zero, zero);
    return moving(frame(body), at(job_.qd, 3 * body), at(job_.qd, 3 * body + 1), at(job_.qd, 3 * body + 2));
  };
  const auto turning = [&](int body) {
    const P omega = body < code_.moving ? at(job_.qd, 3 * body + 2) : P(0);
    return omega * omega;
  };
  for_each_element([&]<class E>(const LaneElement& e) {
    if constexpr (std::is_same_v<E, Revolute<P>>) {
      const E pin = element<E>(e);
      const Vec2<P> g =
          turning(e.body_j) * frame(e.body_j).axis(pin.s_j) - turning(e.body_i) * frame(e.body_i).axis(pin.s_i);
      put(job_.right, e.row, g.x);
      put(job_.right, e.row + 1, g.y);
    } else if constexpr (rolls<E>) {
      put(job_.right, e.row, roll_gamma<E>(e, twist(e.body_i), twist(e.body_j)));
    } else {
      const auto i = moved(e.body_i);
      auto j = i;
      if constexpr (E::bodies == 2) j = moved(e.body_j);
      Taylor<P> rows[E::rows];
      element<E>(e).phi(Arguments<Taylor<P>>{i, j, value(e), {}}, rows);
      for (int r = 0; r < E::rows; ++r) put(job_.right, e.row + r, -(scale(e) * rows[r].dd));
    }
  });
  search(LaneSearch::gamma);
}

template <class V>
template <class E>
void LaneEquations<V>::second(const LaneElement& e, const Twist<P>& u, const Twist<P>& v, P* rows) const {
  if constexpr (rolls<E>) {
    rows[0] = -roll_gamma<E>(e, u, v);
  } else {
    const auto moved = [&](int body, const Twist<P>& rate) {
      return moving(frame(body), rate.vx, rate.vy, rate.omega);
    };
    const auto i = moved(e.body_i, u);
    auto j = i;
    if constexpr (E::bodies == 2) j = moved(e.body_j, v);
    Taylor<P> series[E::rows];
    element<E>(e).phi(Arguments<Taylor<P>>{i, j, Taylor<P>{value(e).f}, {}}, series);
    for (int r = 0; r < E::rows; ++r) rows[r] = scale(e) * series[r].dd;
  }
}

}  // namespace catena
