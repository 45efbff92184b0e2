// relative_x: the difference of the ground abscissas of two points, of body j and of body i, is prescribed.
//
//   h = r_Pj - r_Pi     Phi = h_x - c     Phi_q = [-1, 0, y-part of A_i s'Pi | 1, 0, -(y-part of A_j s'Pj)]
//   nu = c'             gamma = (A_j s'Pj)_x phid_j^2 - (A_i s'Pi)_x phid_i^2 + c''
//
// Symbols: s'Pi, s'Pj in the frames of their bodies and c in m; the axis is the ground's. Never singular. Multiplier:
// -(force on j along x), N. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/pair_motion.hpp"

namespace catena {

template <class S = double>
struct RelativeX {
  static constexpr std::string_view type = "relative_x";
  static constexpr std::string_view summary =
      "The x coordinate of a point of body j, less that of a point of body i, in ground axes, equals c.";
  static constexpr std::string_view equation = "h_x - c = 0,  h = r_Pj - r_Pi";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::length;
  static constexpr std::array pattern = {Entry::minus_one, Entry::zero, Entry::varying,  //
                                         Entry::plus_one,  Entry::zero, Entry::varying};
  static constexpr std::array hessian_pattern = {HessianEntry{2, 2}, HessianEntry{5, 5}};

  Vec2<S> s_i{}, s_j{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &RelativeX::s_i, 0, "the point P_i of body i"},
                           PointField{"j", &RelativeX::s_j, 1, "the point P_j of body j"},
                           FunctionField{"value", 0, UnitKind::length, Omitted::given, "c, the difference"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.measured_along(s_i, {1, 0}, s_j);
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    return separation(i, j, s_i, s_j).x;
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = measure(a.i, a.j) - a.c;
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    entries[0] = a.i.axis(s_i).y;
    entries[1] = -a.j.axis(s_j).y;
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    out[0] = v.omega * v.omega * a.j.axis(s_j).x - u.omega * u.omega * a.i.axis(s_i).x;
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    entries[0] = lambda[0] * a.i.axis(s_i).x;
    entries[1] = -lambda[0] * a.j.axis(s_j).x;
  }
};

}  // namespace catena
