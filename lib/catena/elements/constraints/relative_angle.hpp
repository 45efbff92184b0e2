// relative_angle: the angle of body j with respect to body i is prescribed.
//
//   Phi = phi_j - phi_i - c        Phi_q = [0, 0, -1 | 0, 0, 1]        nu = c'        gamma = c''
//
// c in rad, whole turns count. Never singular. Multiplier: -(torque on j), N m. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct RelativeAngle {
  static constexpr std::string_view type = "relative_angle";
  static constexpr std::string_view summary = "The angle of body j with respect to body i equals c; whole turns count.";
  static constexpr std::string_view equation = "phi_j - phi_i - c = 0";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::angle;
  static constexpr std::array pattern = {Entry::zero, Entry::zero, Entry::minus_one,  //
                                         Entry::zero, Entry::zero, Entry::plus_one};
  static constexpr std::array<HessianEntry, 0> hessian_pattern = {};

  Vec2<S> s_i{}, s_j{};  // where torques are reported; the equation does not contain them

  static constexpr UnitKind row_unit(int) { return UnitKind::angle; }
  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &RelativeAngle::s_i, 0, "body i"}, PointField{"j", &RelativeAngle::s_j, 1, "body j"},
        FunctionField{"value", 0, UnitKind::angle, Omitted::given, "c, the angle of j measured from i"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.turn(s_i, s_j);
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    return j.phi - i.phi;
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = a.j.phi - a.i.phi - a.c;
  }
  void jacobian(const Arguments<double>&, double*) const {}
  void gamma(const Arguments<double>&, const Rates&, const Rates&, double* out) const { out[0] = 0; }
};

}  // namespace catena
