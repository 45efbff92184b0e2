// rack_pinion: pinion j rolls on the straight pitch line of rack i without slip.
//
//   u = A_i u'    h = r_Pj - r_Pi
//   Phi = [(R u)^T h - s R_p; u^T h + s R_p (phi_j - phi_i) - c] (2 equations)
//   Phi_q and gamma: those of slot and displacement, axis_projection.hpp, and -+ s R_p for the angles        nu = 0
//
// Symbols: u' unit vector along the rack in its frame; P_i a point of the pitch line; P_j the pinion's centre; R_p its
// pitch radius, m; s = 1 if the pinion is to the left of u, -1 to the right; c, m, follows from the given
// configuration. Never singular. Multipliers: minus the force that presses the teeth together, N, and minus the force
// on j along the rack, N. Source: Shabana, Computational Dynamics, section 3.4.
#pragma once

#include "catena/elements/axis_projection.hpp"

namespace catena {

template <class S = double>
struct RackPinion {
  static constexpr std::string_view type = "rack_pinion";
  static constexpr std::string_view summary = "Pinion j rolls on the straight pitch line of rack i.";
  static constexpr std::string_view equation =
      "(R u)^T h - s R_p = 0,  u^T h + s R_p (phi_j - phi_i) - c = 0  (2 equations),  h = r_Pj - r_Pi,  u along axis_i";
  static constexpr int rows = 2;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr auto hessian_pattern = projection_hessian_pattern;

  Vec2<S> s_i{}, s_j{}, axis_i{};
  S radius{};
  int side = 1;
  S constant{};  // c

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &RackPinion::s_i, 0, "a point P_i of the rack's pitch line"},
        PointField{"j", &RackPinion::s_j, 1, "the centre P_j of the pinion"},
        AxisField{"axis_i", &RackPinion::axis_i, 0, true, "direction of the rack"},
        NumberField{"radius", &RackPinion::radius, UnitKind::length, Domain::positive, true, "pitch radius R_p"},
        SideField{"side", &RackPinion::side, "1: the pinion is to the left of the rack's direction, -1: to the right"});
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    normalise(axis_i);
    constant = dot(i.axis(axis_i), separation(i, j, s_i, s_j)) + rise() * (j.phi - i.phi);
  }
  const char* check() const {
    if (!has_direction(axis_i)) return "axis_i has no direction";
    return value_of(radius) > 0 ? nullptr : "radius is not above zero";
  }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> u = a.i.axis(axis_i), h = separation(a.i, a.j, s_i, s_j);
    out[0] = cross(u, h) - T(rise());
    out[1] = dot(u, h) + T(rise()) * (a.j.phi - a.i.phi) - T(constant);
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    const PairGeometry geometry(a, s_i, s_j);
    const Vec2<double> u = a.i.axis(axis_i);
    projection_jacobian(geometry, perpendicular(u), entries);
    projection_jacobian(geometry, u, entries + 6);
    entries[8] -= rise();
    entries[11] += rise();
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    const PairMotion motion(a, s_i, s_j, u, v);
    const Vec2<double> axis = a.i.axis(axis_i);
    out[0] = projection_gamma(motion, perpendicular(axis), u.omega);
    out[1] = projection_gamma(motion, axis, u.omega);
  }
  void hessian(const Arguments<double>& a, const double* lambda, double* entries) const {
    const Vec2<double> u = a.i.axis(axis_i);
    projection_hessian(PairGeometry(a, s_i, s_j), lambda[0] * perpendicular(u) + lambda[1] * u, entries);
  }

 private:
  /// s R_p.
  S rise() const { return S(static_cast<double>(side)) * radius; }
};

}  // namespace catena
