// revolute: a point of body i and a point of body j coincide; the bodies turn freely about it.
//
//   h = r_Pj - r_Pi = 0 (2 equations)        Phi_qi = [-I, -R A_i s'Pi]        Phi_qj = [I, R A_j s'Pj]
//   nu = 0                              gamma = A_j s'Pj phid_j^2 - A_i s'Pi phid_i^2
//
// Symbols: s'Pi, s'Pj in the frames of their bodies, m. Never singular by itself. Multipliers: minus the force on j, N.
// Source: Haug, section 3.3.
#pragma once

#include <limits>

#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct Revolute {
  static constexpr std::string_view type = "revolute";
  static constexpr std::string_view summary = "A point of body i and a point of body j coincide: a pin.";
  static constexpr std::string_view equation = "r_Pj - r_Pi = 0  (2 equations)";
  static constexpr int rows = 2;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr std::array pattern = {Entry::minus_one, Entry::zero,      Entry::varying,  //
                                         Entry::plus_one,  Entry::zero,      Entry::varying,  //
                                         Entry::zero,      Entry::minus_one, Entry::varying,  //
                                         Entry::zero,      Entry::plus_one,  Entry::varying};
  static constexpr std::array hessian_pattern = {HessianEntry{2, 2}, HessianEntry{5, 5}};

  Vec2<S> s_i{}, s_j{};
  // NaN: not given. No part of the equations: a model gives the joint a JointDamper.
  S c{std::numeric_limits<double>::quiet_NaN()};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Revolute::s_i, 0, "the pin's place on body i"},
                           PointField{"j", &Revolute::s_j, 1, "the pin's place on body j"},
                           NumberField{"c", &Revolute::c, UnitKind::torsion_damping, Domain::not_negative, false,
                                       "viscous damping of its turning (default 0)"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.pin(s_i, s_j);
  }

  const char* check() const { return value_of(c) < 0 ? "its damping c is negative" : nullptr; }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> h = a.j.point(s_j) - a.i.point(s_i);
    out[0] = h.x;
    out[1] = h.y;
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
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    const Vec2<double> arm_i = a.i.axis(s_i), arm_j = a.j.axis(s_j);
    entries[0] = lambda[0] * arm_i.x + lambda[1] * arm_i.y;
    entries[1] = -(lambda[0] * arm_j.x + lambda[1] * arm_j.y);
  }
};

}  // namespace catena
