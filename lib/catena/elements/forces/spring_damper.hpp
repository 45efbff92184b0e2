// spring_damper: translational spring, damper and actuator between a point of body i and a point of body j.
//
//   h = r_Pj - r_Pi    l = |h|    e = l - l0
//   f = k e + g(e) + c ld + F(t)        on i +f h/l at P_i, on j -f h/l at P_j
//   V = k e^2 / 2 + integral of g from 0 to e + F l, F frozen        dissipation c ld^2
//
// Symbols: k N/m, c N s/m, l0 m, F N (tension positive); g is the optional curve, see force_curve.hpp. l = 0 with a
// length l0 = 0 and no damper, curve or actuator is regular (f h/l = k h); otherwise the direction is lost there: the
// force is then taken as zero. Source: Haug, section 6.2.
#pragma once

#include "catena/elements/force_curve.hpp"
#include "catena/elements/force_element.hpp"

namespace catena {

template <class S = double>
struct SpringDamper {
  static constexpr std::string_view type = "spring_damper";
  static constexpr std::string_view summary = "A spring, a damper and an actuator along the line between two points.";
  static constexpr std::string_view equation = "f = k (l - l0) + g(l - l0) + c dl/dt + F,  +f h/l on i, -f h/l on j";
  static constexpr int bodies = 2;
  static constexpr int functions = 1;

  Vec2<S> s_i, s_j;
  S k{}, c{}, length{-1.0};  // a negative length: not given, taken from the given configuration
  ForceCurve<S> curve = {};

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &SpringDamper::s_i, 0, "the end P_i on body i"},
        PointField{"j", &SpringDamper::s_j, 1, "the end P_j on body j"},
        NumberField{"k", &SpringDamper::k, UnitKind::stiffness, Domain::any, true,
                    "stiffness (with a curve: default 0)", "curve"},
        NumberField{"c", &SpringDamper::c, UnitKind::damping, Domain::any, false, "damping (default 0)"},
        NumberField{"length", &SpringDamper::length, UnitKind::length, Domain::not_negative, false,
                    "free length l0 (default: the given distance)"},
        FunctionField{"force", 0, UnitKind::force, Omitted::zero, "F, added to the tension (default 0)"},
        TableField{"curve", &SpringDamper::curve, UnitKind::length, UnitKind::force,
                   "g, added to the tension: a smooth curve through pairs [elongation l - l0, tension]"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.spring(s_i, s_j, value_of(k) != 0 || curve, value_of(c) != 0);
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    if (length < S(0.0)) length = norm(j.point(s_j) - i.point(s_i));
  }

  bool can_leave_curve() const { return curve.ends(); }
  std::optional<CurveUse> curve_use(const ForceArguments<double>& a) const {
    return curve.use_at(norm(span(a.i, a.j)) - value_of(length));
  }

  /// h = r_Pj - r_Pi.
  template <class T>
  Vec2<T> span(const Frame<T>& i, const Frame<T>& j) const {
    return j.point(s_j) - i.point(s_i);
  }
  /// dh/dt.
  template <class T>
  Vec2<T> span_rate(const ForceArguments<T>& a) const {
    const Vec2<T> arm_i = a.i.axis(s_i), arm_j = a.j.axis(s_j);
    return Vec2<T>{a.v.vx - a.v.omega * arm_j.y, a.v.vy + a.v.omega * arm_j.x} -
           Vec2<T>{a.u.vx - a.u.omega * arm_i.y, a.u.vy + a.u.omega * arm_i.x};
  }

  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const Vec2<T> h = span(a.i, a.j);
    const T square = squared_norm(h);
    Vec2<T> pull = T(k) * h;
    if (value_of(square) > 0) {
      using std::sqrt;
      const T l = sqrt(square), stretch = l - T(length);
      const T rate = dot(h, span_rate(a)) / l;
      T tension = T(k) * stretch + T(c) * rate + a.f[0];
      if (curve) tension += curve.force(stretch);
      pull = (tension / l) * h;
    }
    add_force_at(a.i.axis(s_i), pull, on_i);
    add_force_at(a.j.axis(s_j), -pull, on_j);
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const Vec2<T> h = span(a.i, a.j);
    const T square = squared_norm(h);
    if (!(value_of(square) > 0)) {
      return T(k) * (square + T(length) * T(length)) * T(0.5) + curve.energy(-T(length));
    }
    using std::sqrt;
    const T l = sqrt(square), stretch = l - T(length);
    return T(k) * stretch * stretch * T(0.5) + curve.energy(stretch) + a.f[0] * l;
  }
  double dissipation(const ForceArguments<double>& a) const {
    const Vec2<double> h = span(a.i, a.j);
    const double l = norm(h), rate = l > 0 ? dot(h, span_rate(a)) / l : 0;
    return value_of(c) * rate * rate;
  }
};

}  // namespace catena
