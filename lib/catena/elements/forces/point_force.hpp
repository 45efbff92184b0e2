// point_force: a force at a point of a body, its components functions of time in the ground's or the body's axes.
//
//   Q_i = [F; (R A s'P)^T F]        F = f (ground axes)   or   F = A f (body axes: a follower force)
//   V = -F^T r_P for ground axes with f frozen; a follower force has no potential
//
// Symbols: f in N, s'P in m. Never singular. Source: Haug, section 6.2.
#pragma once

#include "catena/elements/force_element.hpp"

namespace catena {

template <class S = double>
struct PointForce {
  static constexpr std::string_view type = "point_force";
  static constexpr std::string_view summary = "A force at a point of a body, in ground axes or turning with the body.";
  static constexpr std::string_view equation = "Q_i = [F; (R A s'P)^T F]";
  static constexpr int bodies = 1;
  static constexpr int functions = 2;
  static constexpr std::array stiffness_pattern = {HessianEntry{2, 2}};  // where it has a potential

  Vec2<S> s_i;
  bool in_body_axes = false;

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &PointForce::s_i, 0, "the point P of the body"},
        FunctionPairField{"force", 0, UnitKind::force, "components f_x, f_y, functions of time"},
        ChoiceField{"frame", &PointForce::in_body_axes, "ground", "body", "whose axes the components are in"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.force(s_i, in_body_axes);
  }

  bool conservative() const { return !in_body_axes; }

  template <class T>
  Vec2<T> ground_force(const ForceArguments<T>& a) const {
    const Vec2<T> f{a.f[0], a.f[1]};
    return in_body_axes ? a.i.axis(f) : f;
  }
  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>&) const {
    add_force_at(a.i.axis(s_i), ground_force(a), on_i);
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const Vec2<T> p = a.i.point(s_i);
    return -(a.f[0] * (p.x + T(a.ground.x)) + a.f[1] * (p.y + T(a.ground.y)));
  }
  void stiffness(const ForceArguments<double>& a, double* entries) const {
    entries[0] = dot(Vec2<double>{a.f[0], a.f[1]}, a.i.axis(s_i));
  }
};

}  // namespace catena
