#include "catena/drawing/shapes/rope_points.hpp"

#include <cmath>
#include <numbers>

#include "catena/drawing/shapes/placement.hpp"

namespace catena {
namespace {

// Straight pieces of an arc: of a whole turn they are off by half a per cent of the radius, of half a turn by a quarter
// of that.
constexpr int arc_pieces = 32;
// An arc this little short of a whole turn is none, as the rope only grazes the circle. Poses in a page are in steps of
// 1 / 65535 of all travel: a hundredth is what that turns a stretch of a 650th of it.
constexpr double no_contact = 0.01;

struct Circle {
  Vec2<double> centre;
  double radius;
};

Vec2<double> direction(const Circle& from, const Circle& to) {
  const Vec2<double> h = to.centre - from.centre;
  const double offset = to.radius - from.radius, square = squared_norm(h);
  return (std::sqrt(square - offset * offset) * h - offset * perpendicular(h)) / square;
}

/// Corners between the two ends of the arc on a circle.
void add_arc(std::vector<Vec2<double>>& points, const Circle& circle, const Vec2<double>& before,
             const Vec2<double>& after) {
  const double sense = circle.radius > 0 ? 1 : -1;
  double contact = sense * std::atan2(cross(before, after), dot(before, after));
  if (contact < -no_contact) contact += 2 * std::numbers::pi;
  for (int k = 1; k < arc_pieces; ++k) {
    const double turned = sense * contact * k / arc_pieces, c = std::cos(turned), s = std::sin(turned);
    const Vec2<double> u{c * before.x - s * before.y, s * before.x + c * before.y};
    points.push_back(circle.centre - circle.radius * perpendicular(u));
  }
}

}  // namespace

std::vector<Vec2<double>> rope_points(const RopePath& rope, std::span<const Frame<double>> frames) {
  std::vector<Circle> circles;
  for (const RopeNode& node : rope.nodes)
    circles.push_back({frame_of_body(frames, node.body).point(node.centre), node.radius});
  std::vector<Vec2<double>> points;
  Vec2<double> before{};
  for (std::size_t k = 0; k + 1 < circles.size(); ++k) {
    const Circle &from = circles[k], &to = circles[k + 1];
    const Vec2<double> along = direction(from, to);
    if (k > 0 && from.radius != 0) add_arc(points, from, before, along);
    points.push_back(from.centre - from.radius * perpendicular(along));
    if (k + 2 < circles.size() || !rope.leads_on) points.push_back(to.centre - to.radius * perpendicular(along));
    before = along;
  }
  return points;
}

}  // namespace catena
