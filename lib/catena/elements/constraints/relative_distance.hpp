// relative_distance: a point of body j keeps a prescribed distance from a point of body i.
//
//   h = r_Pj - r_Pi       Phi = h^T h - c^2       Phi_qi = -2 h^T [I, R A_i s'Pi]       Phi_qj = 2 h^T [I, R A_j s'Pj]
//   nu = 2 c c'            gamma = -2 hd^T hd + 2 h^T (A_j s'Pj phid_j^2 - A_i s'Pi phid_i^2) + 2 c'^2 + 2 c c''
//
// Symbols: s'Pi, s'Pj in the frames of their bodies and c in m, c > 0. At c = 0 the gradient vanishes with h: refused;
// a revolute joint takes its place. The solver scales the equation by 1/(2c), to the unit of a length; multipliers,
// N/m, belong to the form above. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/squared_distance.hpp"

namespace catena {

template <class S = double>
struct RelativeDistance {
  static constexpr std::string_view type = "relative_distance";
  static constexpr std::string_view summary = "A point of body j keeps the distance c > 0 from a point of body i.";
  static constexpr std::string_view equation = "h^T h - c^2 = 0,  h = r_Pj - r_Pi";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr bool squared = true;
  static constexpr UnitKind value_unit = UnitKind::length;
  static constexpr auto hessian_pattern = squared_distance_hessian_pattern;

  Vec2<S> s_i{}, s_j{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &RelativeDistance::s_i, 0, "the point P_i on body i"},
                           PointField{"j", &RelativeDistance::s_j, 1, "the point P_j on body j"},
                           FunctionField{"value", 0, UnitKind::length, Omitted::given, "c, the distance, not zero"});
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    return norm(separation(i, j, s_i, s_j));
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = squared_norm(separation(a.i, a.j, s_i, s_j)) - a.c * a.c;
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    squared_distance_jacobian(PairGeometry(a, s_i, s_j), entries);
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    out[0] = squared_distance_gamma(PairMotion(a, s_i, s_j, u, v));
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    squared_distance_hessian(PairGeometry(a, s_i, s_j), lambda[0], entries);
  }
};

}  // namespace catena
