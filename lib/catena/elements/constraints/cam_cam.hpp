// cam_cam: two cams, a curve of body i and a curve of body j, touch.
//
//   p_i, p_j and tangents p_i', p_j' in the frame of i        contact: p_i' x p_j' = 0, p_i'^T (p_j - p_i) = 0
//   Phi = n^T (p_j - p_i), n = R p_i' / |p_i'|        N = A_i n, r_C the contact
//   Phi_qi = [-N^T, -((r_C - r_i) x N)]      Phi_qj = [N^T, (r_C - r_j) x N]      nu = 0
//
// Phi is the gap along the common normal, m, positive to the left of curve i. Both parameters are values of the
// state: Newton's method from the common normal found last; one more step in the scalar of the derivatives carries
// their derivatives exactly, and as Phi is stationary in both this makes gamma and the second derivatives exact. Of
// several common normals the shortest in the given configuration is followed; see common_normal.hpp for what kinds
// there are. Open curves go on as straight lines; curve_use() reports a place beyond an end. Singular where the
// curvatures are equal, hollow against round.
// Multiplier: minus the normal force on j along N, N. Source: Haug, section 3.4 (cam-follower).
#pragma once

#include <type_traits>

#include "catena/elements/common_normal.hpp"
#include "catena/elements/element.hpp"

namespace catena {

template <class S = double>
struct CamCam {
  static constexpr std::string_view type = "cam_cam";
  static constexpr std::string_view summary = "Two cams, a curve of body i and a curve of body j, touch.";
  static constexpr std::string_view equation =
      "n^T (p_j(s_j) - p_i(s_i)) = 0,  p_i' x p_j' = 0,  p_i'^T (p_j - p_i) = 0,  n = R p_i'/|p_i'|";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_i{}, s_j{};  // where torques are reported
  BodyCurve<S> curve_i{}, curve_j{};
  CommonNormal given_normal{};

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &CamCam::s_i, 0, "the body with the first cam"},
                           PointField{"j", &CamCam::s_j, 1, "the body with the second cam"},
                           CurveField{"curve_i", &CamCam::curve_i, 0, "the first cam, in the frame of body i"},
                           CurveField{"curve_j", &CamCam::curve_j, 1, "the second cam, in the frame of body j"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.curve_on_i(curve_i);
    pen.curve_on_j(curve_j);
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    if (curve_i && curve_j && !(curve_i.is_line() && curve_j.is_line()))
      given_normal = search_normal(curve_i, curve_j, plain(seen_from(i, j)));
  }
  const char* check() const {
    if (!curve_i || !curve_j) return "lacks a curve";
    if (curve_i.is_line() && curve_j.is_line()) return "two straight lines have no point of contact";
    if (curve_i.holds() || curve_j.holds()) return "a cam cannot have \"beyond\": \"hold\"; use \"error\" or \"line\"";
    return given_normal.kind < 0 ? "the cams have no common normal in the given configuration" : nullptr;
  }
  const char* trouble(const Arguments<double>& a) const {
    return a.contact->is_regular ? nullptr : "the cams have no single point of contact: their curvatures are equal";
  }

  CurvePlace place() const { return {.s_i = given_normal.s_i, .s_j = given_normal.s_j}; }
  /// Not regular, and the place as it was, where no common normal of the given one's kind is found.
  void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const {
    const Frame<double> relative = seen_from(i, j);
    CommonNormal normal = follow_normal(curve_i, curve_j, relative, place.s_i, place.s_j);
    if (normal.kind != given_normal.kind) normal = search_normal(curve_i, curve_j, relative, given_normal.kind);
    place.is_regular = normal.kind >= 0;
    if (place.is_regular) place.s_i = normal.s_i, place.s_j = normal.s_j;
  }
  bool can_leave_curve() const { return curve_i.ends() || curve_j.ends(); }
  /// Of the two curves the one that is further beyond its end.
  std::optional<CurveUse> curve_use(const Arguments<double>& a) const {
    if (!curve_j.ends()) return curve_i.use_at(a.contact->s_i);
    CurveUse j = curve_j.use_at(a.contact->s_j);
    j.body = 1;
    if (!curve_i.ends()) return j;
    const CurveUse i = curve_i.use_at(a.contact->s_i);
    return i.excess() > j.excess() ? i : j;
  }

  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    const Frame<T> relative = seen_from(a.i, a.j);
    T s(a.contact->s_i), t(a.contact->s_j);
    // The value itself is stationary in s and t.
    if (a.contact->is_regular && !std::is_same_v<T, double>) {
      const CurvePoint<T> i = curve_i.evaluate(s), j = seen_from(curve_j.evaluate(t), relative);
      const TangencyMatrix m(plain(i), plain(j));
      const T f = cross(i.d1, j.d1), g = dot(i.d1, j.p - i.p);
      s = s + (T(m.b) * g - T(m.d) * f) / T(m.determinant);
      t = t + (T(m.c) * f - T(m.a) * g) / T(m.determinant);
    }
    const CurvePoint<T> i = curve_i.evaluate(s), j = seen_from(curve_j.evaluate(t), relative);
    out[0] = cross(i.d1, j.p - i.p) / norm(i.d1);
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    const CurvePoint<double> c = curve_i.plain(a.contact->s_i);
    contact_jacobian(a.i, a.j, a.i.point(c.p), a.i.axis(c.normal()), entries);
  }
};

}  // namespace catena
