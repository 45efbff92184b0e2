// slot: a pin on body j slides in a straight slot of body i (the composite of a revolute and a translational joint).
//
//   v = A_i v'         h = r_Pj - r_Pi         Phi = (R v)^T h - c
//   Phi_qi = [-(R v)^T, -v^T (h + A_i s'Pi)]   Phi_qj = [(R v)^T, v^T A_j s'Pj]
//   nu = c'            gamma = phid_i^2 (R v)^T h + 2 phid_i v^T hd - (R v)^T hdd + c''
//
// Symbols: v' unit vector along the slot in the frame of i; c in m, the offset of the pin to the left of the slot's
// centre line, 0 unless given; hd, hdd as in pair_motion.hpp. Never singular. Multiplier: -(force on j across the
// slot, to the left), N. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/axis_projection.hpp"

namespace catena {

template <class S = double>
struct Slot {
  static constexpr std::string_view type = "slot";
  static constexpr std::string_view summary =
      "A pin on body j slides in a straight slot of body i, at the offset c from its centre line.";
  static constexpr std::string_view equation = "(R v)^T h - c = 0,  h = r_Pj - r_Pi,  v along axis_i";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::length;
  static constexpr auto hessian_pattern = projection_hessian_pattern;

  Vec2<S> s_i{}, s_j{}, axis_i{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Slot::s_i, 0, "a point P_i of the slot, on body i"},
                           PointField{"j", &Slot::s_j, 1, "the pin P_j on body j"},
                           AxisField{"axis_i", &Slot::axis_i, 0, true, "direction of the slot in body i"},
                           FunctionField{"value", 0, UnitKind::length, Omitted::zero,
                                         "c, the offset to the left of the axis (default 0)"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.slot(s_i, axis_i, s_j);
  }

  void complete(const Frame<S>&, const Frame<S>&) { normalise(axis_i); }
  const char* check() const { return has_direction(axis_i) ? nullptr : "axis_i has no direction"; }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    return cross(i.axis(axis_i), separation(i, j, s_i, s_j));
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = measure(a.i, a.j) - a.c;
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    projection_jacobian(PairGeometry(a, s_i, s_j), perpendicular(a.i.axis(axis_i)), entries);
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    out[0] = projection_gamma(PairMotion(a, s_i, s_j, u, v), perpendicular(a.i.axis(axis_i)), u.omega);
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    projection_hessian(PairGeometry(a, s_i, s_j), lambda[0] * perpendicular(a.i.axis(axis_i)), entries);
  }
};

}  // namespace catena
