// Newton's method along a curve, in plain numbers: how contact elements find the point where two bodies touch.
//
// A search starts from the parameter found last, so that it follows one point of contact and costs one or two
// evaluations of the curve; only where that fails does it look everywhere.
#pragma once

#include <cmath>

#include "catena/elements/body_curve.hpp"

namespace catena {

/// First and second derivative, with respect to the curve parameter, of the function that is minimal at the contact,
/// and the size that the second one is compared with: where it is not positive beside that there is no such contact.
struct Descent {
  double slope, bend, size;
};

inline constexpr double singular_bend = 1e-9;
/// The longest step, in parts of the curve's range.
inline constexpr double longest_search_step = 1.0 / 8;

/// Moves s to a minimum; `descent` maps a CurvePoint<double> to Descent. False, s being anything, if Newton's method
/// meets a place that is no minimum or does not converge.
template <class S, class F>
bool follow_minimum(const BodyCurve<S>& curve, const F& descent, double& s) {
  constexpr int attempts = 30;
  const double range = curve.range(), longest = longest_search_step * range, enough = 1e-9 * range;
  if (std::isnan(s)) return false;
  for (int k = 0; k < attempts; ++k) {
    const Descent d = descent(curve.plain(s));
    if (!(d.bend > singular_bend * d.size)) return false;
    const double step = -d.slope / d.bend;
    s += std::abs(step) > longest ? std::copysign(longest, step) : step;
    // The remaining error is the step squared over the range.
    if (std::abs(step) <= enough) {
      s = curve.within(s);
      return true;
    }
  }
  return false;
}

/// Of half the squared distance of the curve from x.
inline Descent foot_descent(const CurvePoint<double>& c, const Vec2<double>& x) {
  const double size = squared_norm(c.d1);
  return {dot(c.p - x, c.d1), size + dot(c.p - x, c.d2), size};
}

/// Moves s to the foot of x, from where it is or else from the nearest point. False, and s that point, where the
/// distance has no proper minimum.
template <class S>
bool follow_foot(const BodyCurve<S>& curve, const Vec2<double>& x, double& s) {
  const auto towards = [&](const CurvePoint<double>& c) { return foot_descent(c, x); };
  if (follow_minimum(curve, towards, s) || follow_minimum(curve, towards, s = curve.nearest(x))) return true;
  s = curve.nearest(x);
  return false;
}

/// The sample at which `value` of the CurvePoint<double> is least.
template <class S, class F>
double least_sample(const BodyCurve<S>& curve, const F& value) {
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (double s : curve.samples()) {
    if (const double v = value(curve.plain(s)); v < least) least = v, best = s;
  }
  return best;
}

}  // namespace catena
