// Gears, belts and racks: pitch circles with teeth that mesh as they do in the given configuration.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catena/drawing/shapes/pen.hpp"
#include "catena/drawing/shapes/symbols.hpp"

namespace catena {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
Vec2<double> on_circle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

/// Height of a tooth above and below the pitch circle.
double half_height(double radius, int teeth) { return radius / teeth; }

/// A toothed rim about `centre`: trapezoids, a tooth centred at the angle `phase`.
DrawnLine toothed_rim(const Vec2<double>& centre, double radius, int teeth, double phase) {
  DrawnLine rim{.role = Role::gear, .closed = true, .filled = true};
  const double pitch = full_turn / teeth, height = half_height(radius, teeth);
  for (int k = 0; k < teeth; ++k) {
    const double middle = phase + k * pitch;
    rim.points.push_back(centre + on_circle(radius - height, middle - 0.35 * pitch));
    rim.points.push_back(centre + on_circle(radius + height, middle - 0.15 * pitch));
    rim.points.push_back(centre + on_circle(radius + height, middle + 0.15 * pitch));
    rim.points.push_back(centre + on_circle(radius - height, middle + 0.35 * pitch));
  }
  return rim;
}

/// Where the tangents that a belt follows leave the first circle: the angle from the line of centres. Zero unless the
/// circles are apart.
double wrap_angle(double radius_i, double radius_j, double distance, bool crossed) {
  const double cosine = (crossed ? radius_i + radius_j : radius_i - radius_j) / distance;
  return std::abs(cosine) < 1 ? std::acos(cosine) : 0;
}

}  // namespace

void Pen::wheel(int body, const Vec2<double>& centre, DrawnLine rim, double spoke) {
  builder_.attach(body, centre);
  builder_.has_look(body);
  if (rim.filled) {
    DrawnLine area = rim;
    area.role = Role::wheel;
    builder_.add({.element = element_, .body_i = body}, {{std::move(area)}});
    rim.filled = false;
  }
  DrawnSymbol look{{std::move(rim)}};
  // One spoke shows the turning.
  if (spoke > 0) look.lines.push_back({.role = Role::gear, .points = {centre, centre + Vec2<double>{spoke, 0}}});
  builder_.add({.element = element_, .body_i = body}, std::move(look));
}

void Pen::toothed_wheel(const DrawingBuilder::Wheel& known, bool ring) {
  builder_.remember(known);
  DrawnLine rim = toothed_rim(known.centre, known.radius, known.teeth, known.phase);
  if (ring) {
    rim.filled = false;
    DrawnLine outside{.role = Role::gear, .points = {known.centre}, .radius = 1.1 * known.radius};
    builder_.add({.element = element_, .body_i = known.body}, {{outside}});
  }
  if (!ring) builder_.add_disc(known.body, known.centre, known.radius);
  wheel(known.body, known.centre, std::move(rim), ring ? 0 : 0.7 * known.radius);
}

// At the pitch point a tooth of one wheel stands in a gap of the other. `part` is how far the pitch point is from the
// middle of a tooth of i, in pitches; angles of wheels outside of each other grow against each other there.
void Pen::gears(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j, bool internal) {
  const Frame<double> i = given(i_), j = given(j_);
  const Vec2<double> h = j.point(s_j) - i.point(s_i);
  const double theta = std::atan2(h.y, h.x);
  const bool i_inside = internal && radius_i < radius_j;
  const double at_i = (i_inside ? theta + std::numbers::pi : theta) - i.phi;
  const double at_j = (internal && !i_inside ? theta : theta + std::numbers::pi) - j.phi;
  DrawingBuilder::Wheel first{i_, s_i, radius_i, builder_.teeth_of(radius_i), at_i};
  DrawingBuilder::Wheel second{j_, s_j, radius_j, builder_.teeth_of(radius_j), at_j};
  const auto* known_i = builder_.find_wheel(i_, s_i, radius_i);
  const auto* known_j = builder_.find_wheel(j_, s_j, radius_j);
  const double way = internal ? 1 : -1;
  const double offset = internal ? 0 : 0.5;  // the rim of a ring is seen from inside: its gaps point outwards
  const auto mesh = [&](const DrawingBuilder::Wheel& known, double at_known, DrawingBuilder::Wheel& other, double at) {
    const double part = (at_known - known.phase) * known.teeth / full_turn;
    other.phase = at - (way * part + offset) * full_turn / other.teeth;
  };
  if (known_i) first = *known_i;
  if (known_j) second = *known_j;
  if (known_j && !known_i) {
    mesh(second, at_j, first, at_i);
  } else if (!known_j) {
    mesh(first, at_i, second, at_j);
  }
  if (!known_i) toothed_wheel(first, internal && !i_inside);
  if (!known_j) toothed_wheel(second, i_inside);
}

void Pen::belt(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j, bool crossed) {
  builder_.add_disc(i_, s_i, radius_i);
  builder_.add_disc(j_, s_j, radius_j);
  wheel(i_, s_i, {.role = Role::gear, .points = {s_i}, .radius = radius_i, .filled = true}, 0.7 * radius_i);
  wheel(j_, s_j, {.role = Role::gear, .points = {s_j}, .radius = radius_j, .filled = true}, 0.7 * radius_j);
  // In the axes of the line of centres the belt stands still: joints hold the centres at this distance.
  const double distance = norm(given(j_).point(s_j) - given(i_).point(s_i));
  const double angle = wrap_angle(radius_i, radius_j, distance, crossed);
  DrawnLine belt{.role = Role::belt, .closed = true, .width = 0.45};
  constexpr int pieces = 32;
  for (int k = 0; k <= pieces; ++k)
    belt.points.push_back(on_circle(radius_i, angle + k * (full_turn - 2 * angle) / pieces));
  for (int k = 0; k <= pieces; ++k) {
    const double part = static_cast<double>(k) / pieces;
    const double along =
        crossed ? std::numbers::pi - angle - part * (full_turn - 2 * angle) : -angle + part * 2 * angle;
    belt.points.push_back(Vec2<double>{distance, 0} + on_circle(radius_j, along));
  }
  builder_.add(
      {.anchor = Anchor::centres, .element = element_, .body_i = i_, .body_j = j_, .point_i = s_i, .point_j = s_j},
      {{belt}});
}

void Pen::rope(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j) {
  const std::vector<RopePath>& paths = builder_.model().rope_paths;
  const auto known = std::lower_bound(paths.begin(), paths.end(), element_,
                                      [](const RopePath& path, int element) { return path.element < element; });
  RopePath path{.element = element_, .nodes = {{i_, s_i, radius_i}, {j_, s_j, radius_j}}};
  if (known != paths.end() && known->element == element_) path = *known;
  const std::size_t own = path.nodes.size() - (path.leads_on ? 1 : 0);
  for (std::size_t k = 0; k < own; ++k) {
    const RopeNode& node = path.nodes[k];
    builder_.attach(node.body, node.centre);
    if (k == 0 && node.radius != 0) continue;  // drawn by the part of the rope that ends there
    if (node.body < 0) point(ground, node.centre, ground, {1, 0}, ground_pin_symbol());
    if (node.radius != 0) pulley(node);
  }
  builder_.add_rope(std::move(path), {{{.role = Role::cable}}});
}

// A rope that slides says nothing of how its pulley turns; one that rolls turns it, which a spoke shows.
void Pen::pulley(const RopeNode& node) {
  const double radius = std::abs(node.radius);
  if (node.rolls) {
    builder_.add_disc(node.body, node.centre, radius);
    return wheel(node.body, node.centre,
                 {.role = Role::gear, .points = {node.centre}, .radius = radius, .filled = true}, 0.7 * radius);
  }
  for (const Role role : {Role::wheel, Role::gear})
    builder_.add({.element = element_, .body_i = node.body},
                 {{{.role = role, .points = {node.centre}, .radius = radius, .filled = role == Role::wheel}}});
}

void Pen::rack_and_pinion(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j, double radius,
                          int side) {
  const int teeth = builder_.teeth_of(radius);
  const Frame<double> i = given(i_), j = given(j_);
  const Vec2<double> axis = axis_i / norm(axis_i), to_rack = i.axis(-static_cast<double>(side) * perpendicular(axis));
  // A gap of the pinion points at the rack, which has a tooth there.
  const double phase = std::atan2(to_rack.y, to_rack.x) - j.phi + std::numbers::pi / teeth;
  builder_.attach(i_, s_i);
  builder_.has_look(i_);
  builder_.add_guide({.body_i = i_,
                      .body_j = j_,
                      .point_i = s_i,
                      .axis_i = axis,
                      .point_j = s_j,
                      .module = 2 * radius / teeth,
                      .side = static_cast<double>(side)},
                     {.anchor = Anchor::body, .element = element_, .body_i = i_}, bar_symbol(0, Role::gear));
  if (!builder_.find_wheel(j_, s_j, radius)) toothed_wheel({j_, s_j, radius, teeth, phase}, false);
}

}  // namespace catena
