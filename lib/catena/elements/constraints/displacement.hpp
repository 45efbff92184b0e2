// displacement: how far a point of body j has moved from a point of body i along an axis of i is prescribed.
//
//   v = A_i v'         h = r_Pj - r_Pi         Phi = v^T h - c
//   Phi_qi = [-v^T, v x (h + A_i s'Pi)]        Phi_qj = [v^T, -(v x A_j s'Pj)]
//   nu = c'            gamma = phid_i^2 v^T h - 2 phid_i (v x hd) - v^T hdd + c''
//
// Symbols: v' unit vector in the frame of i; c in m; a x b = a_x b_y - a_y b_x; hd, hdd as in pair_motion.hpp. The way
// across the axis and the angle stay free. Never singular. Multiplier: -(force on j along v), N.
// Source: Haug, section 3.3.
#pragma once

#include "catena/elements/axis_projection.hpp"

namespace catena {

template <class S = double>
struct Displacement {
  static constexpr std::string_view type = "displacement";
  static constexpr std::string_view summary =
      "The displacement of a point of body j from a point of body i, along an axis of i, equals c.";
  static constexpr std::string_view equation = "v^T h - c = 0,  h = r_Pj - r_Pi,  v along axis_i";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::length;
  static constexpr auto hessian_pattern = projection_hessian_pattern;

  Vec2<S> s_i{}, s_j{}, axis_i{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Displacement::s_i, 0, "the point P_i of body i, from which is measured"},
                           PointField{"j", &Displacement::s_j, 1, "the point P_j of body j"},
                           AxisField{"axis_i", &Displacement::axis_i, 0, true, "direction fixed in body i"},
                           FunctionField{"value", 0, UnitKind::length, Omitted::given, "c, the displacement"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.measured_along(s_i, axis_i, s_j);
  }

  void complete(const Frame<S>&, const Frame<S>&) { normalise(axis_i); }
  const char* check() const { return has_direction(axis_i) ? nullptr : "axis_i has no direction"; }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    return dot(i.axis(axis_i), separation(i, j, s_i, s_j));
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = measure(a.i, a.j) - a.c;
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    projection_jacobian(PairGeometry(a, s_i, s_j), a.i.axis(axis_i), entries);
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    out[0] = projection_gamma(PairMotion(a, s_i, s_j, u, v), a.i.axis(axis_i), u.omega);
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    projection_hessian(PairGeometry(a, s_i, s_j), lambda[0] * a.i.axis(axis_i), entries);
  }
};

}  // namespace catena
