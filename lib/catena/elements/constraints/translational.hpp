// translational: body j slides along a line of body i without turning against it.
//
//   v = A_i v'    w = A_j w'    h = r_Pj - r_Pi
//   Phi = [(R v)^T h; (R v)^T w] (2 equations)
//   Phi_qi = [-(R v)^T, -v^T (h + A_i s'Pi); 0, 0, -v^T w]       Phi_qj = [(R v)^T, v^T A_j s'Pj; 0, 0, v^T w]
//   nu = 0    gamma = [phid_i^2 (R v)^T h + 2 phid_i v^T hd - (R v)^T hdd; (phid_j - phid_i)^2 (R v)^T w]
//
// Symbols: v', w' unit vectors along the line in the frames of i and j; where w' is left out, the bodies keep the angle
// of the given configuration. hd, hdd as in pair_motion.hpp. The second row, the sine of the angle between the axes, is
// met by parallel and by opposed axes alike; it is singular at a right angle, a quarter turn away from any assembled
// configuration. Multipliers: minus the force on j across the line, N, and minus the torque on j, N m.
// Source: Haug, section 3.3.
#pragma once

#include <limits>

#include "catena/elements/axis_projection.hpp"

namespace catena {

template <class S = double>
struct Translational {
  static constexpr std::string_view type = "translational";
  static constexpr std::string_view summary = "Body j slides along a line of body i without turning against it.";
  static constexpr std::string_view equation =
      "(R v)^T h = 0,  (R v)^T w = 0  (2 equations),  h = r_Pj - r_Pi,  v along axis_i,  w along axis_j";
  static constexpr int rows = 2;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr std::array pattern = {Entry::varying, Entry::varying, Entry::varying,  //
                                         Entry::varying, Entry::varying, Entry::varying,  //
                                         Entry::zero,    Entry::zero,    Entry::varying,  //
                                         Entry::zero,    Entry::zero,    Entry::varying};
  static constexpr auto hessian_pattern = projection_hessian_pattern;

  Vec2<S> s_i{}, s_j{}, axis_i{};
  Vec2<S> axis_j{};  // zero: left out
  // NaN: not given. No part of the equations: a model gives the joint a JointDamper.
  S c{std::numeric_limits<double>::quiet_NaN()};

  static constexpr UnitKind row_unit(int row) { return row == 1 ? UnitKind::angle : UnitKind::length; }
  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Translational::s_i, 0, "a point P_i of the line, on body i"},
                           PointField{"j", &Translational::s_j, 1, "the point P_j of body j that moves along it"},
                           AxisField{"axis_i", &Translational::axis_i, 0, true, "direction of the line in body i"},
                           AxisField{"axis_j", &Translational::axis_j, 1, false,
                                     "the same direction in body j (default: as in the given configuration)"},
                           NumberField{"c", &Translational::c, UnitKind::damping, Domain::not_negative, false,
                                       "viscous damping of its sliding (default 0)"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.slide(s_i, axis_i, s_j, axis_j);
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    if (!has_direction(axis_j)) axis_j = j.to_local(i.axis(axis_i));
    normalise(axis_i);
    normalise(axis_j);
  }
  const char* check() const {
    if (!has_direction(axis_i)) return "axis_i has no direction";
    if (value_of(c) < 0) return "its damping c is negative";
    return has_direction(axis_j) ? nullptr : "axis_j has no direction";
  }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> v = a.i.axis(axis_i);
    out[0] = cross(v, separation(a.i, a.j, s_i, s_j));
    out[1] = cross(v, a.j.axis(axis_j));
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    const Vec2<double> v = a.i.axis(axis_i);
    projection_jacobian(PairGeometry(a, s_i, s_j), perpendicular(v), entries);
    const double cosine = dot(v, a.j.axis(axis_j));
    entries[6] = -cosine;
    entries[7] = cosine;
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    const Vec2<double> line = a.i.axis(axis_i);
    const double turning = v.omega - u.omega;
    out[0] = projection_gamma(PairMotion(a, s_i, s_j, u, v), perpendicular(line), u.omega);
    out[1] = cross(line, a.j.axis(axis_j)) * turning * turning;
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    const Vec2<double> v = a.i.axis(axis_i);
    projection_hessian(PairGeometry(a, s_i, s_j), lambda[0] * perpendicular(v), entries);
    // The sine depends on the difference of the angles alone; minus itself is its second derivative.
    const double sine = lambda[1] * cross(v, a.j.axis(axis_j));
    entries[2] -= sine;
    entries[5] += sine;
    entries[6] -= sine;
  }
};

}  // namespace catena
