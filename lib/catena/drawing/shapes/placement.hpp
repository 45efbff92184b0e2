// Where a shape stands at a configuration: the frame (origin, e_u, e_v) of drawing.hpp.
//
// `frames` are those of the bodies' centroids, model order; lengths m. The page holds the same eight lines in
// apps/viewer/placement.ts.
#pragma once

#include <span>

#include "catena/base/frame.hpp"
#include "catena/drawing/shapes/drawing.hpp"

namespace catena {

struct Placement {
  Vec2<double> origin, e_u, e_v;

  Vec2<double> operator()(const Vec2<double>& p) const { return origin + p.x * e_u + p.y * e_v; }
};

inline Frame<double> frame_of_body(std::span<const Frame<double>> frames, int body) {
  return body < 0 ? Frame<double>{} : frames[static_cast<std::size_t>(body)];
}

/// `size`: that of symbols, m.
inline Placement place(const DrawnShape& shape, std::span<const Frame<double>> frames, double size) {
  const Frame<double> i = frame_of_body(frames, shape.body_i), j = frame_of_body(frames, shape.body_j);
  if (shape.anchor == Anchor::rope) return {{0, 0}, {1, 0}, {0, 1}};
  if (shape.anchor == Anchor::body) return {i.origin(), {i.c, i.s}, {-i.s, i.c}};
  const Vec2<double> p = i.point(shape.point_i);
  if (shape.anchor == Anchor::point) {
    const Vec2<double> along = size * j.axis(shape.point_j);
    return {p, along, perpendicular(along)};
  }
  const Vec2<double> h = j.point(shape.point_j) - p;
  const double length = norm(h);
  const Vec2<double> across = length > 0 ? perpendicular(h) / length : Vec2<double>{0, 1};
  if (shape.anchor == Anchor::span) return {p, h, size * across};
  return {p, Vec2<double>{across.y, -across.x}, across};
}

}  // namespace catena
