// Plane curves in a body frame, for cams, followers and contacts.
//
//   circle   p = centre + radius [cos s, sin s]            s: angle, period 2 pi
//   spline   cubic through points, x(s) and y(s)           s: chord length from the first point, m
//   polar    p = r(s) [cos s, sin s], r a periodic spline  s: angle, period 2 pi
//   line     p = point + s axis / |axis|                   s: arc length, m
//
// Every curve gives p, p', p'', p''' with respect to s: tangent p' / |p'|, curvature (p' x p'') / |p'|^3 (positive
// where the curve turns left). p''' jumps at the knots of the splines, all else is continuous. A natural spline goes on
// as a straight line beyond its ends, so that iterations that stray there come back; the curve itself ends at first()
// and last(), unless that line belongs to it (Beyond::line); ends() reports which. Singular where p' = 0, which chord
// lengths and positive radii exclude in all but absurd tables. S (double or Dual) runs through the shape data; the
// parameter may be any scalar that S converts to, Taylor included.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "catena/base/dual.hpp"
#include "catena/base/spline.hpp"
#include "catena/base/taylor.hpp"
#include "catena/base/vec2.hpp"

namespace catena {

/// A point of a curve, with the first three derivatives with respect to the curve parameter.
template <class T>
struct CurvePoint {
  Vec2<T> p, d1, d2, d3;

  /// Unit vector in the direction of growing parameter.
  Vec2<T> tangent() const { return d1 / norm(d1); }
  /// Unit vector to the left of the tangent.
  Vec2<T> normal() const { return perpendicular(tangent()); }
  /// 1/m, positive where the curve turns left.
  T curvature() const {
    const T speed = norm(d1);
    return cross(d1, d2) / (speed * speed * speed);
  }
};

template <class S>
class Curve {
 public:
  // The factories throw std::invalid_argument for data that define no curve, naming the wrong entry.

  /// Counter-clockwise; radius > 0.
  static Curve circle(const Vec2<S>& centre, const S& radius);
  /// Through the points in their order; `end` is natural (at least 2 points) or periodic (at least 3; the first need
  /// not be repeated at the end). Neighbours may not coincide. `beyond` the ends of a natural one: undefined (error);
  /// the point at the end with its tangent (hold); the straight line along that tangent (line).
  static Curve spline(std::span<const Vec2<S>> points, SplineEnd end, Beyond beyond = Beyond::error);
  /// Radii > 0 at increasing angles that span at most one turn; a full turn repeats the first radius at its end.
  static Curve polar(std::span<const S> angles, std::span<const S> radii);
  /// Unbounded; the axis need not be a unit vector.
  static Curve line(const Vec2<S>& point, const Vec2<S>& axis);

  template <class T>
  CurvePoint<T> evaluate(const T& parameter) const {
    return std::visit([&](const auto& shape) { return shape.evaluate(parameter); }, shape_);
  }

  /// The range of the parameter: one period of a closed curve, without bounds for a line.
  double first() const { return first_; }
  double last() const { return last_; }
  bool periodic() const { return periodic_; }
  Beyond beyond() const { return beyond_; }
  /// Whether the curve has ends beyond which it is not defined.
  bool ends() const { return !periodic_ && beyond_ == Beyond::error && std::isfinite(last_); }

  /// The parameters where p''' jumps, within [first(), last()].
  std::vector<double> knots() const;

  /// The parameter of the point nearest to `local` within [first(), last()]. Minima narrower than an eighth of the
  /// distance between two knots may be overlooked; of equally near points (the centre of a circle) one is returned.
  S nearest(const Vec2<S>& local) const;

 private:
  struct Circle {
    Vec2<S> centre;
    S radius;
    template <class T>
    CurvePoint<T> evaluate(const T& s) const;
  };
  struct Line {
    Vec2<S> point, axis;
    template <class T>
    CurvePoint<T> evaluate(const T& s) const;
  };
  struct Polar {
    Spline<S> radius;
    template <class T>
    CurvePoint<T> evaluate(const T& s) const;
  };
  struct Points {
    Spline<S> x, y;
    S length;
    template <class T>
    CurvePoint<T> evaluate(const T& s) const;
  };
  using Shape = std::variant<Circle, Line, Polar, Points>;

  Curve(Shape shape, double first, double last, bool periodic, Beyond beyond = Beyond::error)
      : shape_(std::move(shape)), first_(first), last_(last), periodic_(periodic), beyond_(beyond) {}

  /// The nearest point by sampling and Newton's method, where there is no closed form.
  S search_nearest(const Vec2<S>& local) const;

  Shape shape_;
  double first_, last_;
  bool periodic_;
  Beyond beyond_;
};

/// `v` in the scalar T.
template <class T, class S>
Vec2<T> convert(const Vec2<S>& v) {
  return {T(v.x), T(v.y)};
}

template <class S>
template <class T>
CurvePoint<T> Curve<S>::Circle::evaluate(const T& s) const {
  using std::cos, std::sin;
  const Vec2<T> arm{T(radius) * cos(s), T(radius) * sin(s)};
  return {convert<T>(centre) + arm, perpendicular(arm), -arm, -perpendicular(arm)};
}

template <class S>
template <class T>
CurvePoint<T> Curve<S>::Line::evaluate(const T& s) const {
  return {convert<T>(point) + s * convert<T>(axis), convert<T>(axis), {}, {}};
}

template <class S>
template <class T>
CurvePoint<T> Curve<S>::Polar::evaluate(const T& s) const {
  using std::cos, std::sin;
  const SplineValue<T> r = radius.evaluate(s);
  const Vec2<T> out{cos(s), sin(s)}, across = perpendicular(out);
  return {r.f * out, r.d1 * out + r.f * across, (r.d2 - r.f) * out + (T(2.0) * r.d1) * across,
          (r.d3 - T(3.0) * r.d1) * out + (T(3.0) * r.d2 - r.f) * across};
}

template <class S>
template <class T>
CurvePoint<T> Curve<S>::Points::evaluate(const T& s) const {
  const SplineValue<T> u = x.evaluate(s), v = y.evaluate(s);
  return {{u.f, v.f}, {u.d1, v.d1}, {u.d2, v.d2}, {u.d3, v.d3}};
}

extern template class Curve<double>;
extern template class Curve<Dual<double, 4>>;

}  // namespace catena
