// Curves of cams, guides and walls, drawn as fine polygons.
#include <cmath>

#include "catena/drawing/shapes/pen.hpp"
#include "catena/drawing/shapes/symbols.hpp"

namespace catena {
namespace {

/// Points on the curve, close enough that its corners do not show: four for each of the curve's samples.
std::vector<Vec2<double>> points_of(const BodyCurve<double>& curve) {
  const std::vector<double> samples = curve.samples();
  std::vector<Vec2<double>> points;
  constexpr int pieces = 4;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    for (int m = 0; m < pieces; ++m)
      points.push_back(curve.plain(samples[k] + m * (samples[k + 1] - samples[k]) / pieces).p);
  }
  if (!curve.shape().periodic()) points.push_back(curve.plain(samples.back()).p);
  return points;
}

/// Strokes on the side of a curve that is not free; `free` is 1 where the free side is to its left.
void hatch(DrawnSymbol& symbol, const BodyCurve<double>& curve, double free) {
  constexpr int strokes = 40;
  constexpr double depth = 0.02;  // of the curve's extent
  const double first = curve.shape().first(), range = curve.range();
  double extent = 0;
  const Vec2<double> start = curve.plain(first).p;
  for (int k = 0; k < strokes; ++k) extent = std::max(extent, norm(curve.plain(first + k * range / strokes).p - start));
  for (int k = 0; k < strokes; ++k) {
    const CurvePoint<double> c = curve.plain(first + (k + 0.5) * range / strokes);
    const Vec2<double> into = -free * c.normal() - 0.7 * c.tangent();
    symbol.lines.push_back({.role = Role::support, .points = {c.p, c.p + depth * extent * into}});
  }
}

}  // namespace

void Pen::curve_on(int body, const BodyCurve<double>& curve, int side) {
  builder_.has_look(body);
  const bool circle = curve.is_circle();
  // A circle runs counter-clockwise, but its free side 1 is the outside: to the right (contact.hpp).
  const double free = circle ? -side : side;
  if (curve.is_line()) {
    const CurvePoint<double> c = curve.plain(0);
    DrawnSymbol look = bar_symbol(0, body < 0 ? Role::support : Role::curve);
    if (side != 0) add_hatching(look, 0, 1, 0, 24, free * 0.01, free * 0.8);
    return builder_.add_guide({.body_i = body, .body_j = body == i_ ? j_ : i_, .point_i = c.p, .axis_i = c.d1},
                              {.anchor = Anchor::span, .element = element_, .body_i = body, .body_j = body},
                              std::move(look));
  }
  DrawnLine line{.role = body < 0 ? Role::support : Role::curve};
  if (circle) {
    builder_.follow(element_, body, curve.centre());
    line.points = {curve.centre()};
    line.radius = curve.radius();
  } else {
    line.points = points_of(curve);
  }
  // What is free inside is a hole, not an area.
  line.closed = curve.shape().periodic();
  line.filled = line.closed && !(circle && side < 0);
  DrawnSymbol look{{std::move(line)}};
  if (side != 0) hatch(look, curve, free);
  builder_.add({.element = element_, .body_i = body}, std::move(look));
}

void Pen::follower_on_j(const Vec2<double>& s_j, double radius) {
  builder_.attach(j_, s_j);
  builder_.follow(element_, j_, s_j);
  if (!(radius > 0)) return point(j_, s_j, ground, {1, 0}, pin_symbol());
  builder_.has_look(j_);
  builder_.add({.element = element_, .body_i = j_},
               {{{.role = Role::gear, .points = {s_j}, .radius = radius, .filled = true}}});
}

}  // namespace catena
