// torsion_spring: rotational spring, damper and actuator between body i and body j.
//
//   n = k (phi_j - phi_i - theta0) + c (phid_j - phid_i) + N(t)        +n on i, -n on j
//   V = k (phi_j - phi_i - theta0)^2 / 2 + N (phi_j - phi_i), N frozen        dissipation c (phid_j - phid_i)^2
//
// Symbols: k N m/rad, c N m s/rad, theta0 rad (whole turns count), N N m. Never singular. Source: Haug, section 6.2.
#pragma once

#include <limits>

#include "catena/elements/force_element.hpp"

namespace catena {

template <class S = double>
struct TorsionSpring {
  static constexpr std::string_view type = "torsion_spring";
  static constexpr std::string_view summary = "A torsion spring, a damper and an actuator between two bodies.";
  static constexpr std::string_view equation =
      "n = k (phi_j - phi_i - theta0) + c (phid_j - phid_i) + N,  +n on i, -n on j";
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr std::array stiffness_pattern = {HessianEntry{2, 2}, HessianEntry{5, 2}, HessianEntry{5, 5}};

  Vec2<S> s_i, s_j;  // bodies only; a torque has no place
  S k{}, c{};
  S angle{std::numeric_limits<double>::quiet_NaN()};  // NaN: not given, taken from the given configuration

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &TorsionSpring::s_i, 0, "body i"}, PointField{"j", &TorsionSpring::s_j, 1, "body j"},
        NumberField{"k", &TorsionSpring::k, UnitKind::torsion_stiffness, Domain::any, true, "stiffness"},
        NumberField{"c", &TorsionSpring::c, UnitKind::torsion_damping, Domain::any, false, "damping (default 0)"},
        NumberField{"angle", &TorsionSpring::angle, UnitKind::angle, Domain::any, false,
                    "free angle theta0 of j measured from i (default: the given one)"},
        FunctionField{"torque", 0, UnitKind::torque, Omitted::zero, "N, added to n (default 0)"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.spiral_spring(s_i, s_j);
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    if (value_of(angle) != value_of(angle)) angle = j.phi - i.phi;
  }

  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const T n = T(k) * (a.j.phi - a.i.phi - T(angle)) + T(c) * (a.v.omega - a.u.omega) + a.f[0];
    on_i.moment += n;
    on_j.moment -= n;
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const T turn = a.j.phi - a.i.phi, stretch = turn - T(angle);
    return T(k) * stretch * stretch * T(0.5) + a.f[0] * turn;
  }
  double dissipation(const ForceArguments<double>& a) const {
    const double rate = a.v.omega - a.u.omega;
    return value_of(c) * rate * rate;
  }
  void stiffness(const ForceArguments<double>&, double* entries) const {
    entries[0] = entries[2] = value_of(k);
    entries[1] = -value_of(k);
  }
};

}  // namespace catena
