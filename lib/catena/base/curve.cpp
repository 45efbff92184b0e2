#include "catena/base/curve.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "catena/base/number_text.hpp"

namespace catena {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double unbounded = std::numeric_limits<double>::infinity();

[[noreturn]] void fail(const std::string& what) { throw std::invalid_argument("curve: " + what); }

template <class S>
void require_finite(const Vec2<S>& v, const std::string& name) {
  if (!std::isfinite(value_of(v.x)) || !std::isfinite(value_of(v.y))) fail(name + " is not finite");
}

void require_positive(double value, const std::string& name) {
  if (!(value > 0) || !std::isfinite(value)) fail(name + " must be positive, is " + number_text(value));
}

std::string entry(const char* name, std::size_t index) { return std::string(name) + "[" + std::to_string(index) + "]"; }

}  // namespace

template <class S>
Curve<S> Curve<S>::circle(const Vec2<S>& centre, const S& radius) {
  require_finite(centre, "the circle's centre");
  require_positive(value_of(radius), "the circle's radius");
  return Curve(Circle{centre, radius}, 0, turn, true);
}

template <class S>
Curve<S> Curve<S>::line(const Vec2<S>& point, const Vec2<S>& axis) {
  require_finite(point, "the line's point");
  require_finite(axis, "the line's axis");
  const S length = norm(axis);
  require_positive(value_of(length), "the length of the line's axis");
  return Curve(Line{point, axis / length}, -unbounded, unbounded, false);
}

template <class S>
Curve<S> Curve<S>::spline(std::span<const Vec2<S>> points, SplineEnd end, Beyond beyond) {
  if (end == SplineEnd::clamped) fail("a spline through points ends natural or periodic, not clamped");
  const bool closed = end == SplineEnd::periodic;
  std::vector<Vec2<S>> path(points.begin(), points.end());
  if (closed && path.size() > 1) {
    if (value_of(norm(path.back() - path.front())) == 0) path.pop_back();
    path.push_back(path.front());
  }
  const std::size_t least = closed ? 3 : 2, distinct = path.size() - (closed && !path.empty() ? 1 : 0);
  if (distinct < least) {
    fail("needs at least " + std::to_string(least) + " different points, has " + std::to_string(distinct));
  }
  std::vector<S> s, x, y;
  for (std::size_t k = 0; k < path.size(); ++k) {
    require_finite(path[k], entry("points", k));
    const S chord = k > 0 ? norm(path[k] - path[k - 1]) : S(0.0);
    if (k > 0 && !(value_of(chord) > 0)) fail(entry("points", k) + " coincides with the point before it");
    s.push_back(k > 0 ? s.back() + chord : S(0.0));
    x.push_back(path[k].x);
    y.push_back(path[k].y);
  }
  return Curve(Points{Spline<S>(s, x, end), Spline<S>(s, y, end), s.back()}, 0, value_of(s.back()), closed, beyond);
}

template <class S>
Curve<S> Curve<S>::polar(std::span<const S> angles, std::span<const S> radii) {
  if (angles.size() != radii.size()) {
    fail(std::to_string(angles.size()) + " angles, but " + std::to_string(radii.size()) + " radii");
  }
  if (angles.size() < 3) fail("needs at least 3 angles, has " + std::to_string(angles.size()));
  for (std::size_t k = 0; k < radii.size(); ++k) require_positive(value_of(radii[k]), entry("radius", k));
  std::vector<S> knots(angles.begin(), angles.end()), values(radii.begin(), radii.end());
  const double span = value_of(knots.back()) - value_of(knots.front());
  if (span > turn + 1e-9) fail("the angles span " + number_text(span) + " rad, more than one turn");
  if (span > turn - 1e-9) {
    // The end of a full turn is its start once more.
    const double start = value_of(values.front()), finish = value_of(values.back());
    if (std::abs(finish - start) > 1e-12 * start) {
      fail("the full turn starts at radius " + number_text(start) + " and ends at " + number_text(finish));
    }
    knots.pop_back();
  } else {
    values.push_back(values.front());
  }
  knots.push_back(knots.front() + S(turn));
  const double first = value_of(knots.front());
  return Curve(Polar{Spline<S>(knots, values, SplineEnd::periodic)}, first, first + turn, true);
}

template <class S>
std::vector<double> Curve<S>::knots() const {
  std::span<const double> knots;
  if (const auto* polar = std::get_if<Polar>(&shape_)) knots = polar->radius.knots();
  if (const auto* points = std::get_if<Points>(&shape_)) knots = points->x.knots();
  return {knots.begin(), knots.end()};
}

template <class S>
S Curve<S>::nearest(const Vec2<S>& local) const {
  using std::atan2;
  if (const auto* circle = std::get_if<Circle>(&shape_)) {
    const Vec2<S> arm = local - circle->centre;
    return value_of(squared_norm(arm)) > 0 ? atan2(arm.y, arm.x) : S(0.0);
  }
  if (const auto* line = std::get_if<Line>(&shape_)) return dot(line->axis, local - line->point);
  return search_nearest(local);
}

template <class S>
S Curve<S>::search_nearest(const Vec2<S>& local) const {
  const Vec2<double> target{value_of(local.x), value_of(local.y)};
  // Half the squared distance, and its first and second derivative.
  const auto distance = [&](double s) {
    const CurvePoint<S> c = evaluate(S(s));
    const auto plain = [](const Vec2<S>& v) { return Vec2<double>{value_of(v.x), value_of(v.y)}; };
    const Vec2<double> gap = plain(c.p) - target, d1 = plain(c.d1), d2 = plain(c.d2);
    return Taylor<double>(squared_norm(gap) / 2, dot(gap, d1), squared_norm(d1) + dot(gap, d2));
  };

  constexpr std::size_t per_piece = 8;
  const std::vector<double> ends = knots();
  const std::size_t count = per_piece * (ends.size() - 1);
  std::vector<double> s(count + 1), sampled(count + 1);
  for (std::size_t k = 0; k <= count; ++k) {
    const std::size_t piece = std::min(k / per_piece, ends.size() - 2);
    const double fraction = static_cast<double>(k - piece * per_piece) / per_piece;
    s[k] = ends[piece] + fraction * (ends[piece + 1] - ends[piece]);
    sampled[k] = distance(s[k]).f;
  }

  double best = unbounded, best_s = s[0];
  for (std::size_t k = 0; k <= count; ++k) {
    if ((k > 0 && sampled[k - 1] < sampled[k]) || (k < count && sampled[k + 1] < sampled[k])) continue;
    // A minimum lies between the neighbours of a sample that is lower than both: Newton, halving where that leaves
    // them.
    double low = s[k > 0 ? k - 1 : 0], high = s[std::min(k + 1, count)], at = s[k];
    for (int iteration = 0; iteration < 60 && low < high; ++iteration) {
      const Taylor<double> d = distance(at);
      (d.d > 0 ? high : low) = at;
      double next = d.dd > 0 ? at - d.d / d.dd : low;
      if (!(next > low && next < high)) next = (low + high) / 2;
      if (d.d == 0 || std::abs(next - at) <= 1e-15 * std::max(std::abs(at), last_ - first_)) break;
      at = next;
    }
    if (const double reached = distance(at).f; reached < best) best = reached, best_s = at;
  }

  // One Newton step in S: it carries the derivative with respect to the point and the shape. At the end of an open
  // curve the parameter stays constant.
  const S start(best_s);
  if (!periodic_ && best_s - first_ < 1e-12 * last_) return S(first_);
  if (const auto* points = std::get_if<Points>(&shape_); !periodic_ && last_ - best_s < 1e-12 * last_) {
    return points->length;
  }
  const CurvePoint<S> c = evaluate(start);
  const S slope = dot(c.p - local, c.d1), curvature = squared_norm(c.d1) + dot(c.p - local, c.d2);
  return value_of(curvature) > 0 ? start - slope / curvature : start;
}

template class Curve<double>;
template class Curve<Dual<double, 4>>;

}  // namespace catena
