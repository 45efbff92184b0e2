// coupler: a massless rod of length l pinned to both bodies (the composite of two revolute joints and a body).
//
//   h = r_Pj - r_Pi       Phi = h^T h - l^2       Phi_qi = -2 h^T [I, R A_i s'Pi]       Phi_qj = 2 h^T [I, R A_j s'Pj]
//   nu = 2 l l'            gamma = -2 hd^T hd + 2 h^T (A_j s'Pj phid_j^2 - A_i s'Pi phid_i^2) + 2 l'^2 + 2 l l''
//
// Symbols: s'Pi, s'Pj in the frames of their bodies and l in m, l > 0. At l = 0 the gradient vanishes with h: refused;
// a revolute joint takes its place. The solver scales the equation by 1/(2l), to the unit of a length; multipliers,
// N/m, belong to the form above; the tension of the rod is 2 l lambda. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/squared_distance.hpp"

namespace catena {

template <class S = double>
struct Coupler {
  static constexpr std::string_view type = "coupler";
  static constexpr std::string_view summary =
      "A massless rod of length l > 0, pinned to a point of body i and a point of body j.";
  static constexpr std::string_view equation = "h^T h - l^2 = 0,  h = r_Pj - r_Pi";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr bool squared = true;
  static constexpr std::string_view value_synonym = "length";  ///< what a rod's value may be called too
  static constexpr UnitKind value_unit = UnitKind::length;
  static constexpr auto hessian_pattern = squared_distance_hessian_pattern;

  Vec2<S> s_i{}, s_j{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Coupler::s_i, 0, "the pin P_i on body i"},
                           PointField{"j", &Coupler::s_j, 1, "the pin P_j on body j"},
                           FunctionField{"value", 0, UnitKind::length, Omitted::given, "l, the length, not zero"});
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
