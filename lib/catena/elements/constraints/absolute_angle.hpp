// absolute_angle: the angle of a body is prescribed.
//
//   Phi = phi_i - c        Phi_q = [0, 0, 1]        nu = c'        gamma = c''
//
// c in rad, whole turns count. Never singular. Multiplier: -(torque), N m. Source: Haug, section 3.2.
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct AbsoluteAngle {
  static constexpr std::string_view type = "absolute_angle";
  static constexpr std::string_view summary = "The angle of a body equals c; whole turns count.";
  static constexpr std::string_view equation = "phi_i - c = 0";
  static constexpr int rows = 1;
  static constexpr int bodies = 1;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::angle;
  static constexpr std::array pattern = {Entry::zero, Entry::zero, Entry::plus_one};
  static constexpr std::array<HessianEntry, 0> hessian_pattern = {};

  Vec2<S> s_i{};  // where the torque is reported; the equation does not contain it

  static constexpr UnitKind row_unit(int) { return UnitKind::angle; }
  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &AbsoluteAngle::s_i, 0, "the body"},
                           FunctionField{"value", 0, UnitKind::angle, Omitted::given, "c, the angle of the body"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.turn(s_i);
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>&) const {
    return i.phi;
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = a.i.phi - a.c;
  }
  void jacobian(const Arguments<double>&, double*) const {}
  void gamma(const Arguments<double>&, const Rates&, const Rates&, double* out) const { out[0] = 0; }
};

}  // namespace catena
