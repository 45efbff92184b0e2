// point_on_curve: a point of body j stays on a curve of body i (a follower with a knife edge, a pin in a cam groove).
//
//   x = A_i^T (r_Pj - r_i)        foot: (p(s) - x)^T p'(s) = 0        Phi = n(s)^T (x - p(s)), n = R p' / |p'|
//   Phi_qi = [-N^T, -((r_Pj - r_i) x N)]      Phi_qj = [N^T, A_j s'Pj x N]      N = A_i n        nu = 0
//
// Phi is the distance to the left of the curve, m. The parameter s is a value of the state: Newton's method from the
// foot found last (the nearest point at first) keeps the branch where a curve crosses itself; one more step in the
// scalar of the derivatives carries ds/dq exactly, and as Phi is stationary in s this makes gamma and the second
// derivatives exact. Beyond the ends of an open curve the equation is that of the straight line along the tangent at
// the end; curve_use() reports a place beyond an end. Singular where x is a centre of curvature, never on the curve.
// Multiplier: minus the normal force on j, N. Source: Haug, section 3.4 (point follower).
#pragma once

#include <type_traits>

#include "catena/elements/curve_search.hpp"
#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct PointOnCurve {
  static constexpr std::string_view type = "point_on_curve";
  static constexpr std::string_view summary = "A point of body j stays on a curve of body i.";
  static constexpr std::string_view equation =
      "n(s)^T (x - p(s)) = 0,  (p(s) - x)^T p'(s) = 0,  x = A_i^T (r_Pj - r_i),  n = R p'/|p'|";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_i{}, s_j{};  // s_i: where torques on i are reported
  BodyCurve<S> curve{};
  double given_foot = std::numeric_limits<double>::quiet_NaN();

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &PointOnCurve::s_i, 0, "the body with the curve"},
                           PointField{"j", &PointOnCurve::s_j, 1, "the point P_j of body j"},
                           CurveField{"curve", &PointOnCurve::curve, 0, "the curve, in the frame of body i"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.curve_on_i(curve);
    pen.follower_on_j(s_j, S{});
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    if (curve) given_foot = curve.nearest(plain(local(i, j, s_j)));
  }
  const char* check() const { return curve ? nullptr : "has no curve"; }
  const char* trouble(const Arguments<double>& a) const {
    return a.contact->is_regular ? nullptr : "the point is at a centre of curvature of the curve";
  }

  CurvePlace place() const { return {.s_i = given_foot}; }
  /// Not regular where the distance has no proper minimum.
  void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const {
    place.is_regular = follow_foot(curve, local(i, j, plain(s_j)), place.s_i);
  }
  bool can_leave_curve() const { return curve.ends(); }
  std::optional<CurveUse> curve_use(const Arguments<double>& a) const { return curve.use_at(a.contact->s_i); }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> x = local(a.i, a.j, s_j);
    T s(a.contact->s_i);
    // The value itself is stationary in s.
    if (a.contact->is_regular && !std::is_same_v<T, double>) {
      const CurvePoint<T> c = curve.evaluate(s);
      s = s - dot(c.p - x, c.d1) / T(foot_descent(plain(c), plain(x)).bend);
    }
    const CurvePoint<T> c = curve.evaluate(s);
    out[0] = cross(c.d1, x - c.p) / norm(c.d1);
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    contact_jacobian(a.i, a.j, a.j.point(s_j), a.i.axis(curve.plain(a.contact->s_i).normal()), entries);
  }

 private:
  /// The point in the frame of the curve.
  template <class T, class U>
  static Vec2<T> local(const Frame<T>& i, const Frame<T>& j, const Vec2<U>& point) {
    return i.to_local(j.point(point) - i.origin());
  }
};

}  // namespace catena
