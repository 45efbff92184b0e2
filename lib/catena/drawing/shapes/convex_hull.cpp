#include <algorithm>

#include "catena/drawing/shapes/drawing_builder.hpp"

namespace catena {
namespace {

/// Monotone chain over sorted points: one half of the hull, without its last corner.
template <class Iterator>
std::vector<Vec2<double>> half_hull(Iterator first, Iterator last, double flat) {
  std::vector<Vec2<double>> hull;
  for (; first != last; ++first) {
    while (hull.size() >= 2) {
      const Vec2<double> a = hull[hull.size() - 2], b = hull.back();
      if (cross(b - a, *first - b) > flat) break;
      hull.pop_back();
    }
    hull.push_back(*first);
  }
  hull.pop_back();
  return hull;
}

}  // namespace

std::vector<Vec2<double>> convex_hull(std::vector<Vec2<double>> points) {
  const auto before = [](const Vec2<double>& a, const Vec2<double>& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  };
  std::sort(points.begin(), points.end(), before);
  const auto same = [](const Vec2<double>& a, const Vec2<double>& b) { return a.x == b.x && a.y == b.y; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) return points;
  // A triangle thinner than a billionth of the body's extent is a line.
  const Vec2<double> extent = points.back() - points.front();
  const double flat = 1e-9 * squared_norm(extent);
  std::vector<Vec2<double>> hull = half_hull(points.begin(), points.end(), flat);
  const std::vector<Vec2<double>> upper = half_hull(points.rbegin(), points.rend(), flat);
  hull.insert(hull.end(), upper.begin(), upper.end());
  return hull;
}

}  // namespace catena
