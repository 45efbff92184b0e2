// Gears, belts and racks: pitch circles with teeth that mesh as they do in the given configuration.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catena/drawing/shapes/pen.hpp"
#include "catena/drawing/shapes/symbols.hpp"

namespace catena {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr int least_teeth = 12, most_teeth = 160;  // fewer look like stars, more like a thick line

Vec2<double> on_circle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

/// Teeth of a wheel of this radius where the smaller wheel of a pair has at least `least_teeth`.
int teeth_of(double radius, double smaller) {
  return std::min(most_teeth, static_cast<int>(std::lround(least_teeth * 1.5 * radius / smaller)));
}

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
  // One spoke shows the turning.
  DrawnLine mark{.role = Role::gear, .points = {centre, centre + Vec2<double>{spoke, 0}}};
  builder_.add({.element = element_, .body_i = body}, {{std::move(rim), std::move(mark)}});
}

void Pen::gears(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j, bool internal) {
  const Frame<double> i = given(i_), j = given(j_);
  const Vec2<double> h = j.point(s_j) - i.point(s_i);
  const double theta = std::atan2(h.y, h.x), smaller = std::min(radius_i, radius_j);
  const int teeth_i = teeth_of(radius_i, smaller), teeth_j = teeth_of(radius_j, smaller);
  // A tooth of i and a gap of j point at the pitch point; inside of a ring both look the same way.
  const bool i_inside = internal && radius_i < radius_j;
  const double towards_i = i_inside ? theta + std::numbers::pi : theta;
  const double towards_j = internal && !i_inside ? theta : theta + std::numbers::pi;
  DrawnLine rim_i = toothed_rim(s_i, radius_i, teeth_i, towards_i - i.phi);
  DrawnLine rim_j = toothed_rim(s_j, radius_j, teeth_j, towards_j - j.phi + std::numbers::pi / teeth_j);
  if (internal) {
    const bool ring_is_i = radius_i > radius_j;
    (ring_is_i ? rim_i : rim_j).filled = false;
    const double radius = ring_is_i ? radius_i : radius_j;
    DrawnLine outside{.role = Role::gear, .points = {ring_is_i ? s_i : s_j}, .radius = 1.1 * radius};
    builder_.add({.element = element_, .body_i = ring_is_i ? i_ : j_}, {{outside}});
  }
  wheel(i_, s_i, std::move(rim_i), 0.7 * radius_i);
  wheel(j_, s_j, std::move(rim_j), 0.7 * radius_j);
}

void Pen::belt(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j, bool crossed) {
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

void Pen::rack_and_pinion(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j, double radius,
                          int side) {
  const int teeth = teeth_of(radius, radius);
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
  wheel(j_, s_j, toothed_rim(s_j, radius, teeth, phase), 0.7 * radius);
}

}  // namespace catena
