// torque: a torque on body i, a function of time; body j, if given, gets the opposite.
//
//   Q_i = [0, 0, n]        Q_j = [0, 0, -n]        V = -n (phi_i - phi_j), n frozen
//
// n in N m. Never singular. Source: Haug, section 6.2.
#pragma once

#include "catena/elements/force_element.hpp"

namespace catena {

template <class S = double>
struct Torque {
  static constexpr std::string_view type = "torque";
  static constexpr std::string_view summary = "A torque on body i; body j, if given, gets the opposite one.";
  static constexpr std::string_view equation = "n on i, -n on j";
  static constexpr int bodies = 2;
  static constexpr bool second_body_optional = true;
  static constexpr int functions = 1;
  static constexpr std::array<HessianEntry, 0> stiffness_pattern = {};

  Vec2<S> s_i, s_j;  // bodies only; a torque has no place

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Torque::s_i, 0, "the body that gets n"},
                           PointField{"j", &Torque::s_j, 1, "the body that gets -n (default: the ground)"},
                           FunctionField{"torque", 0, UnitKind::torque, Omitted::refused, "n, a function of time"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.turn(s_i, s_j);
  }

  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    on_i.moment += a.f[0];
    on_j.moment -= a.f[0];
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    return a.f[0] * (a.j.phi - a.i.phi);
  }
};

}  // namespace catena
