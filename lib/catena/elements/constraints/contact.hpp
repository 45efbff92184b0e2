// contact: a point of body j, or a disc around it, stays on the free side of a curve of body i.
//
//   x = A_i^T (r_Pj - r_i)        Psi = side n(s)^T (x - p(s)) - radius >= 0        s: foot of x, n = R p' / |p'|
//
// The free side is on the left of the curve's direction (side 1: inside a circle, which runs counter-clockwise; above a
// line along x) or on its right (side -1). Foot, derivatives and singular cases are those of point_on_curve.hpp: of
// several feet the nearest one is taken first and then followed. p: normal force on j along side N, N; no friction.
// k and c are those of the penalty that dynamics is to use; equilibrium takes the inequality itself. Source: as
// point_on_curve.hpp and gap_element.hpp.
#pragma once

#include "catena/elements/constraints/point_on_curve.hpp"
#include "catena/elements/gap_element.hpp"

namespace catena {

template <class S = double>
struct Contact : PointOnCurve<S> {
  using Base = PointOnCurve<S>;
  static constexpr std::string_view type = "contact";
  static constexpr std::string_view summary =
      "A point of body j, or a disc around it, stays on the free side of a curve of body i; no friction.";
  static constexpr std::string_view equation =
      "side n(s)^T (x - p(s)) - radius >= 0,  x = A_i^T (r_Pj - r_i),  s: foot of x,  n = R p'/|p'|";
  static constexpr bool one_sided = true;

  S radius{}, k{}, c{};
  int side = 1;

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &Contact::s_i, 0, "the body with the curve"},
        PointField{"j", &Contact::s_j, 1, "the point P_j of body j"},
        CurveField{"curve", &Contact::curve, 0, "the curve, in the frame of body i"},
        NumberField{"radius", &Contact::radius, UnitKind::length, Domain::not_negative, false,
                    "of a disc around P_j (default 0: a point)"},
        SideField{"side", &Contact::side, "the free side: 1 on the left of the curve's direction, -1 on its right"},
        NumberField{"k", &Contact::k, UnitKind::stiffness, Domain::positive, false,
                    "penalty stiffness for dynamics; equilibrium needs none"},
        NumberField{"c", &Contact::c, UnitKind::damping, Domain::not_negative, false,
                    "penalty damping for dynamics; equilibrium needs none"});
  }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    Base::phi(a, out);
    out[0] = T(static_cast<double>(side)) * out[0] - T(radius);
  }
  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    T gap;
    phi(Arguments<T>{i, j, T(0.0), {}}, &gap);
    return gap;
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    Base::jacobian(a, entries);
    for (std::size_t n = 0; n < jacobian_size<Base>; ++n) entries[n] *= side;
  }
};

}  // namespace catena
