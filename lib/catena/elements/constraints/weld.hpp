// weld: body j keeps its place and angle with respect to body i.
//
//   Phi = [r_Pj - r_Pi; phi_j - phi_i - c] (3 equations), c the angle between the frames in the given configuration
//   nu = 0        gamma = [A_j s'Pj phid_j^2 - A_i s'Pi phid_i^2; 0]
//
// Symbols: s'Pi, s'Pj in the frames of their bodies, m; c in rad. Never singular. A body welded to the ground is not
// solved for at all: the plan eliminates it. Multipliers: minus force, N, and torque, N m, on j.
// Source: Haug, section 3.3 (the joint that leaves no freedom).
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct Weld {
  static constexpr std::string_view type = "weld";
  static constexpr std::string_view summary =
      "Body j is fixed to body i at a point, at the angle of the given configuration.";
  static constexpr std::string_view equation = "r_Pj - r_Pi = 0,  phi_j - phi_i - c = 0  (3 equations)";
  static constexpr int rows = 3;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr std::array pattern = {Entry::minus_one, Entry::zero,      Entry::varying,    //
                                         Entry::plus_one,  Entry::zero,      Entry::varying,    //
                                         Entry::zero,      Entry::minus_one, Entry::varying,    //
                                         Entry::zero,      Entry::plus_one,  Entry::varying,    //
                                         Entry::zero,      Entry::zero,      Entry::minus_one,  //
                                         Entry::zero,      Entry::zero,      Entry::plus_one};
  static constexpr std::array hessian_pattern = {HessianEntry{2, 2}, HessianEntry{5, 5}};

  Vec2<S> s_i{}, s_j{};
  S angle{};  // c

  static constexpr UnitKind row_unit(int row) { return row == 2 ? UnitKind::angle : UnitKind::length; }
  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Weld::s_i, 0, "the weld's place on body i"},
                           PointField{"j", &Weld::s_j, 1, "the weld's place on body j"});
  }

  void complete(const Frame<S>& i, const Frame<S>& j) { angle = j.phi - i.phi; }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> h = a.j.point(s_j) - a.i.point(s_i);
    out[0] = h.x;
    out[1] = h.y;
    out[2] = a.j.phi - a.i.phi - T(angle);
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    const Vec2<double> arm_i = a.i.axis(s_i), arm_j = a.j.axis(s_j);
    entries[0] = arm_i.y;
    entries[1] = -arm_j.y;
    entries[2] = -arm_i.x;
    entries[3] = arm_j.x;
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    const Vec2<double> g = (v.omega * v.omega) * a.j.axis(s_j) - (u.omega * u.omega) * a.i.axis(s_i);
    out[0] = g.x;
    out[1] = g.y;
    out[2] = 0;
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    const Vec2<double> arm_i = a.i.axis(s_i), arm_j = a.j.axis(s_j);
    entries[0] = lambda[0] * arm_i.x + lambda[1] * arm_i.y;
    entries[1] = -(lambda[0] * arm_j.x + lambda[1] * arm_j.y);
  }
};

}  // namespace catena
