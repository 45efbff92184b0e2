// cam_flat: a cam, a curve of body i, touches a flat face of body j.
//
//   w = A_j w'    N = R w    contact: N^T A_i p'(s) = 0        Phi = N^T (r_C - r_Pj), r_C = r_i + A_i p(s)
//   Phi_qi = [N^T, (r_C - r_i) x N]      Phi_qj = [-N^T, -((r_C - r_j) x N)]      nu = 0
//
// The face is the line through P_j along w', a unit vector in the frame of j; Phi, m, is the cam's distance to the left
// of it. The contact is the point of the cam that lies farthest along N, or against it: whichever is nearer to the face
// in the given configuration. Its parameter is a value of the state: Newton's method in s from the point found last,
// and one more step in the scalar of the derivatives, as in point_on_curve. Where an open curve has no such point its
// end takes its place: as a valid contact where the curve holds there (a corner that slides on the face), else only to
// keep the equation finite; curve_use() reports it. Singular where the cam's curvature vanishes at the contact; a
// straight line is refused. The cam should be convex: over a hollow the followed point need not be the one that
// touches. Multiplier: the normal force on j along N, N. Source: Haug, section 3.4 (flat-faced follower).
#pragma once

#include <type_traits>

#include "catena/elements/curve_search.hpp"
#include "catena/elements/pair_motion.hpp"

namespace catena {

template <class S = double>
struct CamFlat {
  static constexpr std::string_view type = "cam_flat";
  static constexpr std::string_view summary = "A cam, a curve of body i, touches a flat face of body j.";
  static constexpr std::string_view equation =
      "N^T (r_C - r_Pj) = 0,  N^T A_i p'(s) = 0,  r_C = r_i + A_i p(s),  N across axis_j";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_i{}, s_j{}, axis_j{};  // s_i: where torques on i are reported
  BodyCurve<S> curve{};
  double side = 1;  // 1: the contact is farthest along N, -1: against it
  double given_contact = std::numeric_limits<double>::quiet_NaN();
  bool circle = false;
  Vec2<S> centre{};
  S radius{};  // signed: along N

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &CamFlat::s_i, 0, "the body with the cam"},
                           PointField{"j", &CamFlat::s_j, 1, "a point P_j of the face, on body j"},
                           CurveField{"curve", &CamFlat::curve, 0, "the cam, in the frame of body i"},
                           AxisField{"axis_j", &CamFlat::axis_j, 1, true, "direction of the face in body j"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.curve_on_i(curve);
    pen.face_on_j(s_j, axis_j);
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    normalise(axis_j);
    if (!curve || curve.is_line()) return;
    const Vec2<double> n = plain(normal(i, j, axis_j)), face = plain(face_point(i, j));
    CurvePlace place = this->place();
    const auto distance = [&](double of_side) {
      side = of_side;
      find_contact(n, place);
      return std::abs(dot(n, curve.plain(place.s_i).p - face));
    };
    const double along = distance(1);
    if (along <= distance(-1)) side = 1;
    find_contact(n, place);
    given_contact = place.s_i;
    circle = curve.is_circle();
    if (circle) centre = curve.centre(), radius = S(side) * curve.radius();
  }
  const char* check() const {
    if (!curve) return "has no curve";
    if (curve.is_line()) return "a straight line and a flat face have no point of contact";
    return has_direction(axis_j) ? nullptr : "axis_j has no direction";
  }
  const char* trouble(const Arguments<double>& a) const {
    return a.contact->is_regular || (curve.holds() && is_end(a.contact->s_i))
               ? nullptr
               : "the cam has no curvature where it should touch the face";
  }
  CurvePlace place() const { return {.s_i = given_contact}; }
  /// Not regular at the end of an open curve, and where the curvature vanishes. A circle touches everywhere.
  void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const {
    if (circle) {
      place.is_regular = true;
    } else {
      find_contact(normal(i, j, plain(axis_j)), place);
    }
  }
  bool can_leave_curve() const { return curve.ends(); }
  std::optional<CurveUse> curve_use(const Arguments<double>& a) const { return curve.use_at(a.contact->s_i); }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> n = normal(a.i, a.j, axis_j);
    if (circle) {
      out[0] = dot(n, convert<T>(centre) - face_point(a.i, a.j)) + T(radius);
      return;
    }
    T s(a.contact->s_i);
    // The value itself is stationary in s.
    if (a.contact->is_regular && !std::is_same_v<T, double>) {
      const CurvePoint<T> c = curve.evaluate(s);
      s = s - dot(n, c.d1) / T(dot(plain(n), plain(c).d2));
    }
    out[0] = dot(n, curve.evaluate(s).p - face_point(a.i, a.j));
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    const Vec2<double> n = normal(a.i, a.j, axis_j);
    const Vec2<double> contact =
        a.i.point(circle ? plain(centre) + value_of(radius) * n : curve.plain(a.contact->s_i).p);
    contact_jacobian(a.i, a.j, contact, -perpendicular(a.j.axis(axis_j)), entries);
  }

 private:
  bool is_end(double s) const { return s == curve.shape().first() || s == curve.shape().last(); }
  /// N and P_j in the frame of the curve.
  template <class T, class U>
  static Vec2<T> normal(const Frame<T>& i, const Frame<T>& j, const Vec2<U>& axis) {
    return i.to_local(perpendicular(j.axis(axis)));
  }
  template <class T>
  Vec2<T> face_point(const Frame<T>& i, const Frame<T>& j) const {
    return i.to_local(j.point(s_j) - i.origin());
  }
  void find_contact(const Vec2<double>& n, CurvePlace& place) const {
    const Vec2<double> inward = -side * n;
    const double range = curve.range();
    const auto descent = [&](const CurvePoint<double>& c) {
      return Descent{dot(inward, c.d1), dot(inward, c.d2), norm(c.d1) / range};
    };
    double s = place.s_i;
    place.is_regular = follow_minimum(curve, descent, s);
    if (!place.is_regular) {
      place.s_i = s = least_sample(curve, [&](const CurvePoint<double>& c) { return dot(inward, c.p); });
      place.is_regular = follow_minimum(curve, descent, s);
    }
    if (place.is_regular) place.s_i = s;
  }
};

}  // namespace catena
