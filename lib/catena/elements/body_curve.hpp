// A plane curve fixed in a body, as contact elements hold it: a shared shape and the place of the author's frame.
//
// Copies are cheap and share the shape, which never changes. Units: m; the parameter is that of curve.hpp.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "catena/base/curve.hpp"
#include "catena/base/frame.hpp"
#include "catena/elements/element.hpp"

namespace catena {

// Plain numbers of any scalar's.
template <class T>
Frame<double> plain(const Frame<T>& f) {
  return {value_of(f.x), value_of(f.y), value_of(f.phi), value_of(f.c), value_of(f.s)};
}
template <class T>
Vec2<double> plain(const Vec2<T>& v) {
  return {value_of(v.x), value_of(v.y)};
}
template <class T>
CurvePoint<double> plain(const CurvePoint<T>& c) {
  return {plain(c.p), plain(c.d1), plain(c.d2), plain(c.d3)};
}

template <class S>
class BodyCurve {
 public:
  BodyCurve() = default;  ///< no curve
  BodyCurve(Curve<S> shape) : shape_(std::make_shared<const Curve<S>>(std::move(shape))) {}

  explicit operator bool() const { return shape_ != nullptr; }
  const Curve<S>& shape() const { return *shape_; }
  /// Moves the whole curve in its body.
  BodyCurve& operator+=(const Vec2<S>& by) {
    origin_ += by;
    return *this;
  }

  template <class T>
  CurvePoint<T> evaluate(const T& s) const {
    CurvePoint<T> c = shape_->evaluate(s);
    c.p += convert<T>(origin_);
    return c;
  }
  /// The same in plain numbers, whatever S is.
  CurvePoint<double> plain(double s) const { return catena::plain(evaluate(S(s))); }
  /// Parameter of the point nearest to `local`; see Curve::nearest.
  double nearest(const Vec2<double>& local) const {
    return value_of(shape_->nearest(Vec2<S>{S(local.x) - origin_.x, S(local.y) - origin_.y}));
  }

  /// A straight line without ends.
  bool is_line() const { return std::isinf(shape_->first()); }
  /// Whether it comes back to its beginning.
  bool is_closed() const { return shape_->periodic(); }
  /// Whether the curve is a circle; then its centre and radius, in the frame of the body.
  bool is_circle() const { return shape_->periodic() && shape_->knots().empty(); }
  Vec2<S> centre() const {
    const CurvePoint<S> c = evaluate(S(0.0));
    return c.p + c.d2;
  }
  S radius() const { return norm(shape_->evaluate(S(0.0)).d1); }
  /// Length of the parameter's range.
  double range() const { return shape_->last() - shape_->first(); }
  /// s moved by whole periods into the range, on a closed curve.
  double within(double s) const {
    if (!shape_->periodic()) return s;
    return s - std::floor((s - shape_->first()) / range()) * range();
  }
  /// Whether the curve has ends beyond which it is not defined, and the place on it of a contact at s.
  bool ends() const { return shape_ && shape_->ends(); }
  CurveUse use_at(double s) const {
    const double middle = (shape_->first() + shape_->last()) / 2;
    return {s, shape_->first(), shape_->last(), plain(s < middle ? shape_->first() : shape_->last()).p};
  }
  bool holds() const { return shape_ && !shape_->periodic() && shape_->beyond() == Beyond::hold; }
  bool contains(double s) const { return shape_->periodic() || (s >= shape_->first() && s <= shape_->last()); }
  /// Parameters to begin searches from, both ends of the range included: eight a piece of a spline, 48 on a circle.
  std::vector<double> samples() const {
    std::vector<double> ends = shape_->knots(), s;
    int parts = 8;
    if (ends.empty()) {
      ends = {shape_->first(), shape_->last()};
      parts = 48;
    }
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      for (int m = 0; m < parts; ++m) s.push_back(ends[k] + m * (ends[k + 1] - ends[k]) / parts);
    }
    s.push_back(ends.back());
    return s;
  }

 private:
  std::shared_ptr<const Curve<S>> shape_;
  Vec2<S> origin_{};
};

/// Gradient of N^T (r_j - r_i) for two bodies that touch at C along the unit normal N: as the parameters of the contact
/// point are chosen stationary, they take no part in it, and the columns are those of a point fixed in each body.
inline void contact_jacobian(const Frame<double>& i, const Frame<double>& j, const Vec2<double>& contact,
                             const Vec2<double>& normal, double* entries) {
  entries[0] = -normal.x;
  entries[1] = -normal.y;
  entries[2] = -cross(contact - i.origin(), normal);
  entries[3] = normal.x;
  entries[4] = normal.y;
  entries[5] = cross(contact - j.origin(), normal);
}

}  // namespace catena
