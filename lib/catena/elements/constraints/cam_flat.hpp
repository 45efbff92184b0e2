// cam_flat: a cam, a curve of body i, touches a flat face of body j.
//
//   w = A_j w'    N = R w    contact: N^T A_i p'(s) = 0        Phi = N^T (r_C - r_Pj), r_C = r_i + A_i p(s)
//   Phi_qi = [N^T, (r_C - r_i) x N]      Phi_qj = [-N^T, -((r_C - r_j) x N)]      nu = 0
//
// The face is the line through P_j along w', a unit vector in the frame of j; Phi, m, is the cam's distance to the left
// of it. The contact is the point of the cam that lies farthest along N, or against it: whichever is nearer to the face
// in the given configuration. It belongs to the element alone: Newton's method in s from the point found last, and one
// more step in the scalar of the derivatives, as in point_on_curve. Where an open curve has no such point its end takes
// its place: as a valid contact where the curve holds there (a corner that slides on the face), else only to keep the
// equation finite; curve_use() reports it. Singular where the cam's curvature vanishes at the contact; a straight line
// is refused. The cam should be convex: over a hollow the followed point need not be the one that touches. Multiplier:
// the normal force on j along N, N. Source: Haug, section 3.4 (flat-faced follower).
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
  mutable double parameter = std::numeric_limits<double>::quiet_NaN();  // of the contact found last
  bool circle = false;
  Vec2<S> centre{};
  S radius{};                                    // signed: along N
  mutable Vec2<double> found_for{parameter, 0};  // N at the last search, and whether it found
  mutable bool found = false;

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
    found_for = {std::numeric_limits<double>::quiet_NaN(), 0};
    if (!curve || curve.is_line()) return;
    const Vec2<double> n = plain(normal(i, j)), face = plain(face_point(i, j));
    const auto distance = [&] { return std::abs(dot(n, curve.plain(parameter).p - face)); };
    side = 1;
    find_contact(n);
    const double along = distance();
    side = -1;
    find_contact(n);
    if (along <= distance()) side = 1;
    find_contact(n);
    circle = curve.is_circle();
    if (circle) centre = curve.centre(), radius = S(side) * curve.radius();
  }
  const char* check() const {
    if (!curve) return "has no curve";
    if (curve.is_line()) return "a straight line and a flat face have no point of contact";
    return has_direction(axis_j) ? nullptr : "axis_j has no direction";
  }
  const char* trouble(const Arguments<double>& a) const {
    return circle || follow_contact(normal(a.i, a.j)) || (curve.holds() && at_end())
               ? nullptr
               : "the cam has no curvature where it should touch the face";
  }
  CurvePlace place() const { return {.s_i = parameter}; }
  void go_to(const CurvePlace& place) const {
    parameter = place.s_i;
    found_for.x = std::numeric_limits<double>::quiet_NaN();
  }
  bool can_leave_curve() const { return curve.ends(); }
  std::optional<CurveUse> curve_use(const Arguments<double>& a) const {
    follow_contact(normal(a.i, a.j));
    return curve.use_at(parameter);
  }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Vec2<T> n = normal(a.i, a.j);
    if (circle) {
      out[0] = dot(n, convert<T>(centre) - face_point(a.i, a.j)) + T(radius);
      return;
    }
    const bool regular = follow_contact(plain(n));
    T s(parameter);
    // The value itself is stationary in s.
    if (regular && !std::is_same_v<T, double>) {
      const CurvePoint<T> c = curve.evaluate(s);
      s = s - dot(n, c.d1) / T(dot(plain(n), plain(c).d2));
    }
    out[0] = dot(n, curve.evaluate(s).p - face_point(a.i, a.j));
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    const Vec2<double> n = normal(a.i, a.j);
    if (!circle) follow_contact(n);
    const Vec2<double> contact = a.i.point(circle ? plain(centre) + value_of(radius) * n : curve.plain(parameter).p);
    contact_jacobian(a.i, a.j, contact, -perpendicular(a.j.axis(axis_j)), entries);
  }

 private:
  bool at_end() const { return parameter == curve.shape().first() || parameter == curve.shape().last(); }
  /// N and P_j in the frame of the curve.
  template <class T>
  Vec2<T> normal(const Frame<T>& i, const Frame<T>& j) const {
    return i.to_local(perpendicular(j.axis(axis_j)));
  }
  template <class T>
  Vec2<T> face_point(const Frame<T>& i, const Frame<T>& j) const {
    return i.to_local(j.point(s_j) - i.origin());
  }
  /// find_contact(), repeated only for a new direction: equations and their derivatives are evaluated in turns.
  bool follow_contact(const Vec2<double>& n) const {
    if (n.x != found_for.x || n.y != found_for.y) {
      found = find_contact(n);
      found_for = n;
    }
    return found;
  }
  /// Sets `parameter`; false at the end of an open curve, or where the curvature vanishes.
  bool find_contact(const Vec2<double>& n) const {
    const Vec2<double> inward = -side * n;
    const double range = curve.range();
    const auto descent = [&](const CurvePoint<double>& c) {
      return Descent{dot(inward, c.d1), dot(inward, c.d2), norm(c.d1) / range};
    };
    double s = parameter;
    if (follow_minimum(curve, descent, s)) {
      parameter = s;
      return true;
    }
    parameter = s = least_sample(curve, [&](const CurvePoint<double>& c) { return dot(inward, c.p); });
    const bool minimum = follow_minimum(curve, descent, s);
    if (minimum) parameter = s;
    return minimum;
  }
};

}  // namespace catena
