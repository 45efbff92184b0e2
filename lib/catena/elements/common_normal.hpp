// The common normal of two curves, in plain numbers: where two cams touch, or would touch if they met.
//
//   F = [p_i' x p_j'; p_i'^T g] = 0,  g = p_j - p_i        F_s = [p_i'' x p_j', p_i' x p_j''; p_i''^T g - |p_i'|^2,
//   p_i'^T p_j']
//
// for the parameters (s_i, s_j), both curves seen from the frame of i. For curves in contact, parametrised by arc
// length and running against each other, det F_s = -(kappa_i + kappa_j): equal curvatures, hollow against round, have
// no single point of contact. Two common normals are of the same kind if the tangents point the same way or not in both
// and the determinants have the same sign: a motion does not pass from one kind to another without a singular place.
#pragma once

#include <limits>

#include "catena/elements/curve_search.hpp"

namespace catena {

/// The frame of j seen from that of i.
template <class T>
Frame<T> seen_from(const Frame<T>& i, const Frame<T>& j) {
  const Vec2<T> origin = i.to_local(j.origin() - i.origin());
  return {origin.x, origin.y, j.phi - i.phi, i.c * j.c + i.s * j.s, i.c * j.s - i.s * j.c};
}

template <class T>
CurvePoint<T> seen_from(const CurvePoint<T>& p, const Frame<T>& relative) {
  return {relative.point(p.p), relative.axis(p.d1), relative.axis(p.d2), relative.axis(p.d3)};
}

struct CommonNormal {
  double s_i = std::numeric_limits<double>::quiet_NaN(), s_j = s_i;
  int kind = -1;  ///< -1: none found
};

/// F_s at two points, with its determinant.
struct TangencyMatrix {
  double a, b, c, d, determinant, size;

  TangencyMatrix(const CurvePoint<double>& i, const CurvePoint<double>& j)
      : a(cross(i.d2, j.d1)),
        b(cross(i.d1, j.d2)),
        c(dot(i.d2, j.p - i.p) - squared_norm(i.d1)),
        d(dot(i.d1, j.d1)),
        determinant(a * d - b * c),
        size(std::abs(a * d) + std::abs(b * c)) {}

  bool regular() const { return std::abs(determinant) > singular_bend * size; }
  int kind() const { return (d > 0 ? 1 : 0) + (determinant > 0 ? 2 : 0); }
};

/// Newton's method from (s_i, s_j); kind -1 if it fails.
template <class S>
CommonNormal follow_normal(const BodyCurve<S>& curve_i, const BodyCurve<S>& curve_j, const Frame<double>& relative,
                           double s_i, double s_j) {
  constexpr int attempts = 30;
  if (std::isnan(s_i) || std::isnan(s_j)) return {};
  for (int k = 0; k < attempts; ++k) {
    const CurvePoint<double> i = curve_i.plain(s_i), j = seen_from(curve_j.plain(s_j), relative);
    const TangencyMatrix m(i, j);
    if (!m.regular()) return {};
    const double f = cross(i.d1, j.d1), g = dot(i.d1, j.p - i.p);
    double step_i = (m.b * g - m.d * f) / m.determinant, step_j = (m.c * f - m.a * g) / m.determinant;
    // Steps in parts of the smaller curve: a straight line has no size of its own.
    const double speed_i = norm(i.d1), speed_j = norm(j.d1);
    const double reach = std::min(curve_i.range() * speed_i, curve_j.range() * speed_j);
    const double longest = std::max(std::abs(step_i) * speed_i, std::abs(step_j) * speed_j) / reach;
    if (longest > 0.125) step_i *= 0.125 / longest, step_j *= 0.125 / longest;
    s_i += step_i;
    s_j += step_j;
    if (longest <= singular_bend) return {curve_i.within(s_i), curve_j.within(s_j), m.kind()};
  }
  return {};
}

/// Of all common normals between the ends of the curves, or those of one kind, the shortest. Follows, from the samples
/// of one curve, the change of sign of p_i' x p_j' at the nearest point of the other.
template <class S>
CommonNormal search_normal(const BodyCurve<S>& curve_i, const BodyCurve<S>& curve_j, const Frame<double>& relative,
                           int kind = -1) {
  const bool walk_on_i = !curve_i.is_line();
  const BodyCurve<S>&walked = walk_on_i ? curve_i : curve_j, &other = walk_on_i ? curve_j : curve_i;
  // Places on the other curve, in the frame of i.
  const auto place = [&](const BodyCurve<S>& curve, double s) {
    const CurvePoint<double> p = curve.plain(s);
    return &curve == &curve_j ? seen_from(p, relative) : p;
  };
  const std::vector<double> other_s = other.is_line() ? std::vector<double>{} : other.samples();
  std::vector<Vec2<double>> other_p;
  for (double s : other_s) other_p.push_back(place(other, s).p);
  const auto nearest = [&](const Vec2<double>& p) {
    if (other.is_line()) return other.nearest(walk_on_i ? relative.to_local(p - relative.origin()) : p);
    std::size_t best = 0;
    for (std::size_t k = 0; k < other_p.size(); ++k) {
      if (squared_norm(other_p[k] - p) < squared_norm(other_p[best] - p)) best = k;
    }
    return other_s[best];
  };

  CommonNormal best;
  double least = std::numeric_limits<double>::infinity(), before = 0;
  for (double s : walked.samples()) {
    const CurvePoint<double> p = place(walked, s);
    const double t = nearest(p.p), now = cross(p.d1, place(other, t).d1);
    if (before * now <= 0) {
      const CommonNormal found =
          walk_on_i ? follow_normal(curve_i, curve_j, relative, s, t) : follow_normal(curve_i, curve_j, relative, t, s);
      const bool wanted = found.kind >= 0 && (kind < 0 || found.kind == kind);
      if (wanted && curve_i.contains(found.s_i) && curve_j.contains(found.s_j)) {
        const double gap = norm(place(curve_j, found.s_j).p - curve_i.plain(found.s_i).p);
        if (gap < least) least = gap, best = found;
      }
    }
    before = now;
  }
  return best;
}

}  // namespace catena
