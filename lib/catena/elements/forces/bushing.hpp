// bushing: springs and dampers along both axes of body i and against turning, between a point of i and a point of j.
//
//   d = A_i^T (r_Pj - r_Pi)    theta = phi_j - phi_i - theta0
//   F = A_i [kx dx + cx dxd, ky dy + cy dyd]    n = kt theta + ct thetad        at P_j: +F, +n on i and -F, -n on j
//   V = (kx dx^2 + ky dy^2 + kt theta^2) / 2    dissipation cx dxd^2 + cy dyd^2 + ct thetad^2
//
// Symbols: kx, ky N/m, kt N m/rad, cx, cy N s/m, ct N m s/rad, theta0 rad. d is measured in the axes of i, hence the
// rotation of i is part of its rate and F acts on i at the place of P_j, not of P_i. Without force where the points
// coincide and the bodies' angles differ by theta0. Never singular. Source: Haug, section 6.2 (generalised).
#pragma once

#include "catena/elements/force_element.hpp"

namespace catena {

template <class S = double>
struct Bushing {
  static constexpr std::string_view type = "bushing";
  static constexpr std::string_view summary =
      "An elastic bearing: springs and dampers along the axes of body i and against turning.";
  static constexpr std::string_view equation =
      "d = A_i^T (r_Pj - r_Pi),  F = A_i [kx dx + cx dxd, ky dy + cy dyd],  n = kt theta + ct thetad,  "
      "+F, +n on i and -F, -n on j at P_j";
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_i, s_j;
  S kx{}, ky{}, kt{}, cx{}, cy{}, ct{}, angle{};

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &Bushing::s_i, 0, "the point P_i of the body whose axes are used"},
        PointField{"j", &Bushing::s_j, 1, "the point P_j of the other body"},
        NumberField{"kx", &Bushing::kx, UnitKind::stiffness, Domain::any, false, "stiffness along x' of i (default 0)"},
        NumberField{"ky", &Bushing::ky, UnitKind::stiffness, Domain::any, false, "stiffness along y' of i (default 0)"},
        NumberField{"kt", &Bushing::kt, UnitKind::torsion_stiffness, Domain::any, false,
                    "stiffness against turning (default 0)"},
        NumberField{"cx", &Bushing::cx, UnitKind::damping, Domain::any, false, "damping along x' of i (default 0)"},
        NumberField{"cy", &Bushing::cy, UnitKind::damping, Domain::any, false, "damping along y' of i (default 0)"},
        NumberField{"ct", &Bushing::ct, UnitKind::torsion_damping, Domain::any, false,
                    "damping of turning (default 0)"},
        NumberField{"angle", &Bushing::angle, UnitKind::angle, Domain::any, false,
                    "free angle theta0 of j measured from i (default 0)"});
  }

  const char* check() const {
    for (const S& number : {kx, ky, kt, cx, cy, ct}) {
      if (value_of(number) != 0) return nullptr;
    }
    return "has neither stiffness nor damping: give at least one of \"kx\", \"ky\", \"kt\", \"cx\", \"cy\", \"ct\"";
  }

  /// `v` in the axes of the frame.
  template <class T>
  static Vec2<T> in_axes(const Frame<T>& f, const Vec2<T>& v) {
    return {f.c * v.x + f.s * v.y, f.c * v.y - f.s * v.x};
  }
  template <class T>
  Vec2<T> offset(const ForceArguments<T>& a) const {
    return in_axes(a.i, a.j.point(s_j) - a.i.point(s_i));
  }
  /// Its rate as seen from i: A_i^T (velocity of P_j - velocity of the point of i at the same place).
  template <class T>
  Vec2<T> offset_rate(const ForceArguments<T>& a) const {
    const Vec2<T> arm_j = a.j.axis(s_j);
    const Vec2<T> from_i{a.j.x - a.i.x + arm_j.x, a.j.y - a.i.y + arm_j.y};
    return in_axes(a.i, Vec2<T>{a.v.vx - a.v.omega * arm_j.y - a.u.vx + a.u.omega * from_i.y,
                                a.v.vy + a.v.omega * arm_j.x - a.u.vy - a.u.omega * from_i.x});
  }

  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const Vec2<T> d = offset(a), rate = offset_rate(a), arm_j = a.j.axis(s_j);
    const Vec2<T> F = a.i.axis(Vec2<T>{T(kx) * d.x + T(cx) * rate.x, T(ky) * d.y + T(cy) * rate.y});
    const T n = T(kt) * (a.j.phi - a.i.phi - T(angle)) + T(ct) * (a.v.omega - a.u.omega);
    add_force_at(Vec2<T>{a.j.x - a.i.x + arm_j.x, a.j.y - a.i.y + arm_j.y}, F, on_i);
    add_force_at(arm_j, -F, on_j);
    on_i.moment += n;
    on_j.moment -= n;
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const Vec2<T> d = offset(a);
    const T theta = a.j.phi - a.i.phi - T(angle);
    return (T(kx) * d.x * d.x + T(ky) * d.y * d.y + T(kt) * theta * theta) * T(0.5);
  }
  double dissipation(const ForceArguments<double>& a) const {
    const Vec2<double> rate = offset_rate(a);
    const double turning = a.v.omega - a.u.omega;
    return value_of(cx) * rate.x * rate.x + value_of(cy) * rate.y * rate.y + value_of(ct) * turning * turning;
  }
};

}  // namespace catena
