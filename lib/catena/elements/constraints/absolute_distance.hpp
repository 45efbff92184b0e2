// absolute_distance: a point of a body keeps the distance c from a place in the ground frame.
//
//   h = r_P - C        Phi = h^T h - c^2        Phi_q = 2 h^T [I, R A s'P]
//   nu = 2 c c'        gamma = -2 hd^T hd + 2 h^T A s'P phid^2 + 2 c'^2 + 2 c c''
//
// Symbols: C = (C1, C2) and c in m, c > 0. At c = 0 the gradient vanishes with h: refused; absolute_x and absolute_y
// hold a point in place. The solver scales the equation by 1/(2c), to the unit of a length; multipliers, N/m, belong to
// the form above. Source: Haug, section 3.2.
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct AbsoluteDistance {
  static constexpr std::string_view type = "absolute_distance";
  static constexpr std::string_view summary =
      "A point of a body keeps the distance c > 0 from a place in the ground frame.";
  static constexpr std::string_view equation = "h^T h - c^2 = 0,  h = r_P - C";
  static constexpr int rows = 1;
  static constexpr int bodies = 1;
  static constexpr int functions = 1;
  static constexpr bool squared = true;
  static constexpr UnitKind value_unit = UnitKind::length;
  static constexpr std::array hessian_pattern = {HessianEntry{0, 0}, HessianEntry{1, 1}, HessianEntry{2, 0},
                                                 HessianEntry{2, 1}, HessianEntry{2, 2}};

  Vec2<S> s_i{}, ground{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &AbsoluteDistance::s_i, 0, "the point P of the body"},
                           PlaceField{"ground", &AbsoluteDistance::ground, "the place C in the ground frame"},
                           FunctionField{"value", 0, UnitKind::length, Omitted::given, "c, the distance, not zero"});
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>&) const {
    return norm(i.point(s_i) - Vec2<T>{T(ground.x), T(ground.y)});
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> centre{T(ground.x - a.ground.x), T(ground.y - a.ground.y)};
    out[0] = squared_norm(a.i.point(s_i) - centre) - a.c * a.c;
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    const Vec2<double> arm = a.i.axis(s_i), h = separation(a);
    entries[0] = 2 * h.x;
    entries[1] = 2 * h.y;
    entries[2] = 2 * cross(arm, h);
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates&, double* out) const {
    const Vec2<double> arm = a.i.axis(s_i), h = separation(a);
    const Vec2<double> hd = Vec2<double>{u.vx, u.vy} + u.omega * perpendicular(arm);
    out[0] = 2 * (dot(h, arm) * u.omega * u.omega - dot(hd, hd));
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    const Vec2<double> arm = a.i.axis(s_i), h = separation(a);
    const double twice = 2 * lambda[0];
    entries[0] = entries[1] = twice;
    entries[2] = -twice * arm.y;
    entries[3] = twice * arm.x;
    entries[4] = twice * (dot(arm, arm) - dot(h, arm));
  }

 private:
  Vec2<double> separation(const Arguments<double>& a) const {
    return a.i.point(s_i) - (Vec2<double>{value_of(ground.x), value_of(ground.y)} - a.ground);
  }
};

}  // namespace catena
