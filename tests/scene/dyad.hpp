// The joint of two links by elementary geometry: the intersection of two circles.
#pragma once

#include <cmath>

#include "catena/base/vec2.hpp"

namespace catena::testing {

using Point = Vec2<double>;

/// The point at distance a from p and b from q, on the left of the line from p to q (side = 1) or on its right (-1).
inline Point meet(Point p, double a, Point q, double b, int side) {
  const Point line = q - p;
  const double d = norm(line), along = (a * a - b * b + d * d) / (2 * d);
  const double across = side * std::sqrt(a * a - along * along);
  return p + (1 / d) * Point{along * line.x - across * line.y, along * line.y + across * line.x};
}

/// The point with the coordinates (u, v) in the frame with origin p whose x axis points to q.
inline Point beside(Point p, Point q, double u, double v) {
  const Point line = q - p;
  return p + (1 / norm(line)) * Point{u * line.x - v * line.y, u * line.y + v * line.x};
}

inline Point polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

inline double direction(Point from, Point to) { return std::atan2(to.y - from.y, to.x - from.x); }

}  // namespace catena::testing
