// absolute_y: the ground ordinate of a point of a body is prescribed.
//
//   Phi = y_i + x'P sin + y'P cos - c        Phi_q = [0, 1, x'P cos - y'P sin]
//   nu = c'                                  gamma = (x'P sin + y'P cos) phid^2 + c''
//
// Symbols: s'P = (x'P, y'P) in the body frame, m; c in m. Never singular. Multiplier: -(force along y), N.
// Source: Haug, section 3.2.
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct AbsoluteY {
  static constexpr std::string_view type = "absolute_y";
  static constexpr std::string_view summary = "The y coordinate of a point of a body, in the ground frame, equals c.";
  static constexpr std::string_view equation = "y_i + x'P sin(phi_i) + y'P cos(phi_i) - c = 0";
  static constexpr int rows = 1;
  static constexpr int bodies = 1;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::length;
  static constexpr std::array pattern = {Entry::zero, Entry::plus_one, Entry::varying};
  static constexpr std::array hessian_pattern = {HessianEntry{2, 2}};

  Vec2<S> s_i{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &AbsoluteY::s_i, 0, "the point P of the body"},
                           FunctionField{"value", 0, UnitKind::length, Omitted::given, "c, the ordinate of P"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.roller(s_i, {0, 1});
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>&) const {
    return i.point(s_i).y;
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = a.i.point(s_i).y + (T(a.ground.y) - a.c);
  }
  void jacobian(const Arguments<double>& a, double* entries) const { entries[0] = a.i.axis(s_i).x; }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates&, double* out) const {
    out[0] = a.i.axis(s_i).y * u.omega * u.omega;
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    entries[0] = -lambda[0] * a.i.axis(s_i).y;
  }
};

}  // namespace catena
