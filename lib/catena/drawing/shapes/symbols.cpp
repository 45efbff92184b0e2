#include "catena/drawing/shapes/symbols.hpp"

#include <cmath>
#include <numbers>

namespace catena {
namespace {

using Points = std::vector<Vec2<double>>;

constexpr double pin_radius = 0.55, support_height = 2.3, block_length = 2.0, block_height = 1.15;

DrawnLine line(Role role, Points points) { return {.role = role, .points = std::move(points)}; }
DrawnLine area(Role role, Points points) {
  return {.role = role, .points = std::move(points), .closed = true, .filled = true};
}
DrawnLine disc(Role role, const Vec2<double>& centre, double radius) {
  return {.role = role, .points = {centre}, .radius = radius, .filled = true};
}

/// Points on a spiral about the origin; a circular arc where both radii are equal.
Points spiral(double radius_0, double radius_1, double angle_0, double angle_1, int pieces) {
  Points points;
  for (int k = 0; k <= pieces; ++k) {
    const double part = static_cast<double>(k) / pieces;
    const double radius = radius_0 + part * (radius_1 - radius_0), angle = angle_0 + part * (angle_1 - angle_0);
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return points;
}

/// A zigzag from (0, v) to (1, v).
DrawnLine zigzag(double v) {
  constexpr int teeth = 7;
  constexpr double straight = 0.14, height = 0.9;
  Points points{{0, v}, {straight, v}};
  const double pitch = (1 - 2 * straight) / teeth;
  for (int k = 0; k < teeth; ++k) {
    points.push_back({straight + (k + 0.25) * pitch, v + height});
    points.push_back({straight + (k + 0.75) * pitch, v - height});
  }
  points.push_back({1 - straight, v});
  points.push_back({1, v});
  return line(Role::spring, std::move(points));
}

/// A piston in a cup, from (0, v) to (1, v).
void add_dashpot(DrawnSymbol& symbol, double v) {
  constexpr double cup = 0.85, piston = 0.62;
  symbol.lines.push_back(line(Role::spring, {{0, v}, {0.36, v}}));
  symbol.lines.push_back(line(Role::spring, {{0.64, v + cup}, {0.36, v + cup}, {0.36, v - cup}, {0.64, v - cup}}));
  symbol.lines.push_back(line(Role::spring, {{0.54, v + piston}, {0.54, v - piston}}));
  symbol.lines.push_back(line(Role::spring, {{0.54, v}, {1, v}}));
}

}  // namespace

const char* role_name(Role role) {
  constexpr const char* names[roles] = {"wheel", "support", "guide", "curve", "link",   "belt",   "gear",
                                        "cable", "spring",  "rod",   "joint", "driver", "measure"};
  return names[static_cast<int>(role)];
}

void add_hatching(DrawnSymbol& symbol, double u0, double u1, double v, int strokes, double slant, double depth) {
  for (int k = 0; k < strokes; ++k) {
    const double u = u0 + (k + 0.6) * (u1 - u0) / strokes;
    symbol.lines.push_back(line(Role::support, {{u, v}, {u - slant, v - depth}}));
  }
}

DrawnSymbol bar_symbol(double width, Role role) {
  DrawnLine bar = line(role, {{0, 0}, {1, 0}});
  bar.width = width;
  return {{bar}};
}

DrawnSymbol disc_symbol(double radius, Role role) { return {{disc(role, {}, radius)}}; }

DrawnSymbol pin_symbol() { return disc_symbol(pin_radius, Role::joint); }

DrawnSymbol ground_pin_symbol() {
  DrawnSymbol symbol{{area(Role::support, {{0, 0}, {-1.35, -support_height}, {1.35, -support_height}}),
                      line(Role::support, {{-2.1, -support_height}, {2.1, -support_height}})}};
  add_hatching(symbol, -2.1, 2.1, -support_height, 5, 0.7, 0.8);
  return symbol;
}

DrawnSymbol weld_symbol() {
  constexpr double half = 0.6;
  return {{area(Role::joint, {{-half, -half}, {half, -half}, {half, half}, {-half, half}})}};
}

DrawnSymbol ground_weld_symbol() {
  DrawnSymbol symbol{{line(Role::support, {{-2.1, 0}, {2.1, 0}})}};
  add_hatching(symbol, -2.1, 2.1, 0, 5, 0.7, 0.8);
  return symbol;
}

DrawnSymbol block_symbol() {
  return {{area(Role::link, {{-block_length, -block_height},
                             {block_length, -block_height},
                             {block_length, block_height},
                             {-block_length, block_height}})}};
}

DrawnSymbol roller_symbol() {
  constexpr double wheel = 0.4, height = 1.5;
  const double base = height + 2 * wheel;
  DrawnSymbol symbol{{area(Role::support, {{0, 0}, {-1.1, -height}, {1.1, -height}}),
                      disc(Role::support, {-0.7, -height - wheel}, wheel),
                      disc(Role::support, {0.7, -height - wheel}, wheel),
                      line(Role::support, {{-2.1, -base}, {2.1, -base}})}};
  add_hatching(symbol, -2.1, 2.1, -base, 5, 0.7, 0.8);
  return symbol;
}

DrawnSymbol turn_symbol() {
  constexpr double radius = 2.3, last = 4.2;
  const Vec2<double> tip{radius * std::cos(last), radius * std::sin(last)}, along{-std::sin(last), std::cos(last)};
  const Vec2<double> across = perpendicular(along);
  return {{line(Role::driver, spiral(radius, radius, 0.6, last, 24)),
           area(Role::driver, {tip + 0.9 * along, tip + 0.5 * across, tip - 0.5 * across})}};
}

DrawnSymbol cylinder_symbol() {
  constexpr double half = 0.95;
  DrawnLine rod = line(Role::rod, {{0.3, 0}, {1, 0}});
  rod.width = 0.55;
  return {{rod, area(Role::rod, {{0, -half}, {0.58, -half}, {0.58, half}, {0, half}})}};
}

DrawnSymbol spring_symbol(bool elastic, bool damped) {
  if (!elastic && !damped) return cylinder_symbol();
  if (!damped) return {{zigzag(0)}};
  DrawnSymbol symbol;
  if (!elastic) {
    add_dashpot(symbol, 0);
    return symbol;
  }
  constexpr double apart = 1.2, end = 0.1;
  symbol.lines.push_back(line(Role::spring, {{0, 0}, {end, 0}}));
  symbol.lines.push_back(line(Role::spring, {{1 - end, 0}, {1, 0}}));
  for (const double u : {end, 1 - end}) symbol.lines.push_back(line(Role::spring, {{u, apart}, {u, -apart}}));
  DrawnSymbol pair{{zigzag(apart)}};
  add_dashpot(pair, -apart);
  for (DrawnLine& part : pair.lines) {
    for (Vec2<double>& p : part.points) p.x = end + (1 - 2 * end) * p.x;
    symbol.lines.push_back(std::move(part));
  }
  return symbol;
}

DrawnSymbol spiral_symbol() { return {{line(Role::spring, spiral(0.7, 2.4, 0, 5 * std::numbers::pi, 60))}}; }

DrawnSymbol bushing_symbol() {
  constexpr double outer = 1.5, inner = 0.7;
  return {{disc(Role::spring, {}, outer), disc(Role::joint, {}, inner)}};
}

DrawnSymbol face_symbol() {
  constexpr double half = 5;
  DrawnLine face = line(Role::link, {{-half, 0}, {half, 0}});
  face.width = 0.8;
  return {{face}};
}

DrawnSymbol limit_symbol() { return {{line(Role::guide, {{0, -1.8}, {0, 1.8}})}}; }

DrawnSymbol guide_symbol(bool on_ground) {
  constexpr double rail = block_height + 0.25;
  DrawnSymbol symbol;
  for (const double v : {rail, -rail}) {
    symbol.lines.push_back(line(on_ground ? Role::support : Role::guide, {{0, v}, {1, v}}));
  }
  if (on_ground) add_hatching(symbol, 0, 1, -rail, 14, 0.025, 0.8);
  return symbol;
}

// That of a moving body is cut into its link, which it lies upon.
DrawnSymbol slot_symbol(bool on_ground) {
  constexpr double half = 0.8;
  return {{area(on_ground ? Role::guide : Role::joint, {{0, half}, {1, half}, {1, -half}, {0, -half}})}};
}

}  // namespace catena
