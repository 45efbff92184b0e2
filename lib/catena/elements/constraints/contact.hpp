// contact: a point of body j, or a disc around it, stays on the free side of a curve of body i.
//
//   x = A_i^T (r_Pj - r_i)        Psi = b n(s)^T (x - p(s)) - radius >= 0        s: foot of x, n = R p' / |p'|, b = +-1
//
// The free side, side = 1, is on the left of the curve's direction (above a line along x); a circle counts as running
// clockwise, so that its free side is the outside. side = -1: the other one. Foot, derivatives and singular cases are
// those of point_on_curve.hpp: of several feet the nearest one is taken first and then followed. p: normal force on j
// along side N, N. In motion it is rigid, with impacts, or compliant where k is given, with dry friction mu along the
// curve; see analysis/contact/contact_points.hpp. Equilibrium takes the inequality itself and leaves friction out.
// Source: as point_on_curve.hpp and gap_element.hpp.
#pragma once

#include "catena/elements/constraints/point_on_curve.hpp"
#include "catena/elements/gap_element.hpp"

namespace catena {

template <class S = double>
struct Contact : PointOnCurve<S> {
  using Base = PointOnCurve<S>;
  static constexpr std::string_view type = "contact";
  static constexpr std::string_view summary =
      "A point of body j, or a disc around it, stays on the free side of a curve of body i.";
  static constexpr std::string_view equation =
      "+-n(s)^T (x - p(s)) - radius >= 0,  x = A_i^T (r_Pj - r_i),  s: foot of x,  n = R p'/|p'|";
  static constexpr bool one_sided = true;

  static constexpr double touching = 1e-6;  // a gap of this part of the curve is none

  S radius{}, k{}, c{}, exponent{1.0};
  S restitution{}, rest_speed{-1.0};  // negative: not given
  S mu{}, mu_static{-1.0}, vs{};
  int side = 1;

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &Contact::s_i, 0, "the body with the curve"},
        PointField{"j", &Contact::s_j, 1, "the point P_j of body j"},
        CurveField{"curve", &Contact::curve, 0, "the curve, in the frame of body i"},
        NumberField{"radius", &Contact::radius, UnitKind::length, Domain::not_negative, false,
                    "of a disc around P_j (default 0: a point)"},
        SideField{
            "side", &Contact::side,
            "the free side: 1 (default) outside of a circle, on the left of any other curve's direction; -1 the other"},
        NumberField{"k", &Contact::k, UnitKind::stiffness, Domain::positive, false,
                    "stiffness in motion: N = k d^exponent + c d' at a depth d (default: rigid, with impacts)"},
        NumberField{"c", &Contact::c, UnitKind::damping, Domain::not_negative, false, "damping beside k (default 0)"},
        NumberField{"exponent", &Contact::exponent, UnitKind::none, Domain::positive, false,
                    "of the depth (default 1; 1.5: Hertz)"},
        NumberField{"restitution", &Contact::restitution, UnitKind::none, Domain::not_negative, false,
                    "of rigid impacts, 0 ... 1 (default 0): the part of the closing speed that comes back"},
        NumberField{"rest_speed", &Contact::rest_speed, UnitKind::velocity, Domain::not_negative, false,
                    "a slower rebound is none (default: 1e-4 of the speed of the motion)"},
        NumberField{"mu", &Contact::mu, UnitKind::none, Domain::not_negative, false,
                    "coefficient of dry friction while it slides, in motion (default 0)"},
        NumberField{"mu_static", &Contact::mu_static, UnitKind::none, Domain::not_negative, false,
                    "up to which it sticks (default: mu)"},
        NumberField{"vs", &Contact::vs, UnitKind::velocity, Domain::positive, false,
                    "friction is mu N tanh(slip / vs) (default: exact, it sticks and slides)"});
  }
  const char* check() const {
    if (const char* wrong = Base::check()) return wrong;
    return check_impact_and_friction(value_of(restitution), value_of(mu), value_of(mu_static));
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.wall_on_i(this->curve, side);
    pen.follower_on_j(this->s_j, radius);
  }

  /// An open contact does not use the curve.
  std::optional<CurveUse> curve_use(const Arguments<double>& a) const {
    double gap;
    phi(a, &gap);
    if (gap > touching * this->curve.range()) return {};
    return Base::curve_use(a);
  }

  // 1 where the normal points to the free side: that of a circle, counter-clockwise in its parameter, points inwards.
  double free_side() const { return this->curve.is_circle() ? -side : side; }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    Base::phi(a, out);
    out[0] = T(free_side()) * out[0] - T(radius);
  }
  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j, const CurvePlace& contact) const {
    T gap;
    phi(Arguments<T>{i, j, T(0.0), {}, &contact}, &gap);
    return gap;
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    Base::jacobian(a, entries);
    for (std::size_t n = 0; n < jacobian_size<Base>; ++n) entries[n] *= free_side();
  }
};

}  // namespace catena
