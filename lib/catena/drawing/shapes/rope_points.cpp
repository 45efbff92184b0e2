#include "catena/drawing/shapes/rope_points.hpp"

#include <algorithm>
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

double length_between(const Circle& from, const Circle& to) {
  const double offset = to.radius - from.radius;
  return std::sqrt(squared_norm(to.centre - from.centre) - offset * offset);
}

/// Angle of contact of a circle, rad; below zero the rope from a to b would have to cross itself to touch it.
double contact_between(const Circle& a, const Circle& between, const Circle& b) {
  const Vec2<double> before = direction(a, between), after = direction(between, b);
  double contact = std::atan2(cross(before, after), dot(before, after));
  if (between.radius < 0) contact = -contact;
  if (contact < 0) contact += 2 * std::numbers::pi;
  const double needed = std::abs(between.radius) * std::tan((2 * std::numbers::pi - contact) / 2);
  const bool crosses =
      contact > most_contact_of_ropes && length_between(a, between) > needed && length_between(between, b) > needed;
  return crosses ? contact - 2 * std::numbers::pi : contact;
}

/// Takes out the circles that the rope passes, of those before `last`, where its own way ends. Each pass changes one,
/// that which is wrong by most.
void leave_out_those_passed(std::vector<Circle>& circles, std::size_t last) {
  std::vector<char> off(circles.size(), 0);
  for (std::size_t pass = 0; pass < 2 * circles.size(); ++pass) {
    std::size_t changed = 0;
    double worst = 0;
    for (std::size_t k = 1; k < last; ++k) {
      if (circles[k].radius == 0) continue;
      std::size_t a = k - 1, b = k + 1;
      while (off[a]) --a;
      while (off[b]) ++b;
      const double contact = contact_between(circles[a], circles[k], circles[b]);
      const double wrong = off[k] ? (contact < std::numbers::pi ? contact : 0) : -contact;
      if (!(wrong > worst)) continue;
      worst = wrong;
      changed = k;
    }
    if (changed == 0) break;
    off[changed] = !off[changed];
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    if (!off[k]) circles[kept++] = circles[k];
  }
  circles.resize(kept);
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
  std::size_t corners = rope.leads_on ? 1 : 2;
  for (std::size_t k = 1; k + 1 < circles.size(); ++k) corners += circles[k].radius != 0 ? arc_pieces + 1 : 2;
  if (circles.size() > 2) leave_out_those_passed(circles, circles.size() - (rope.leads_on ? 2 : 1));
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
  // As many corners in every pose.
  if (!points.empty()) points.resize(std::max(corners, points.size()), points.back());
  return points;
}

}  // namespace catena
