// Linkages for the tests of kinematics, with their closed-form motion.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {

/// A four-bar: ground pivots (0, 0) and (d, 0), crank a, coupler b, rocker c.
struct FourBar {
  double a = 0.1, b = 0.25, c = 0.2, d = 0.3;

  struct Angles {
    double coupler, rocker;
  };
  /// Angles for a crank angle: the joint B lies to the left of the line from A to the rocker's pivot (side +1) or to
  /// its right (-1).
  Angles at(double crank, int side = 1) const {
    const Vec2<double> tip{a * std::cos(crank), a * std::sin(crank)}, pivot{d, 0};
    const Vec2<double> s = pivot - tip;
    const double distance = norm(s);
    const double turn = std::acos((b * b + distance * distance - c * c) / (2 * b * distance));
    const double coupler = std::atan2(s.y, s.x) + side * turn;
    const Vec2<double> joint = tip + b * Vec2<double>{std::cos(coupler), std::sin(coupler)} - pivot;
    return {coupler, std::atan2(joint.y, joint.x)};
  }
};

/// A rod of 1 kg between two points.
inline int add_rod(Model& model, const std::string& name, Vec2<double> from, Vec2<double> to) {
  const Vec2<double> s = to - from;
  const double length = norm(s);
  const int body = model.add_body(
      name, {.mass = 1, .inertia = length * length / 12, .position = 0.5 * (from + to), .angle = std::atan2(s.y, s.x)});
  model.add_point(body, "from", {-length / 2, 0});
  model.add_point(body, "to", {length / 2, 0});
  return body;
}

/// Pins the named ends of two rods together (or a place of the ground to one).
inline int pin(Model& model, const std::string& name, int i, const char* end_i, int j, const char* end_j) {
  return model.add(name, Revolute<>{*model.find_point(i, end_i), *model.find_point(j, end_j)}, i, j);
}
inline int pin(Model& model, const std::string& name, Vec2<double> place, int j, const char* end_j) {
  return model.add(name, Revolute<>{place, *model.find_point(j, end_j)}, ground, j);
}

inline TimeFunction<double> ramp(double start, double rate) {
  return TimeFunction<double>::polynomial(std::array{start, rate});
}

/// The driven four-bar as a model: bodies crank, coupler, rocker; pins O, A, B, C; driver "drive".
inline std::shared_ptr<Model> driven_four_bar(const FourBar& f, const TimeFunction<double>& angle, int side = 1) {
  auto model = std::make_shared<Model>();
  const double crank_angle = angle.evaluate(0).f;
  const FourBar::Angles angles = f.at(crank_angle, side);
  const Vec2<double> tip{f.a * std::cos(crank_angle), f.a * std::sin(crank_angle)};
  const Vec2<double> joint = tip + f.b * Vec2<double>{std::cos(angles.coupler), std::sin(angles.coupler)};
  const int crank = add_rod(*model, "crank", {0, 0}, tip);
  const int coupler = add_rod(*model, "coupler", tip, joint);
  const int rocker = add_rod(*model, "rocker", {f.d, 0}, joint);
  pin(*model, "O", {0, 0}, crank, "from");
  pin(*model, "A", crank, "to", coupler, "from");
  pin(*model, "B", coupler, "to", rocker, "to");
  pin(*model, "C", {f.d, 0}, rocker, "from");
  model->add_driver("drive", AbsoluteAngle<>{}, crank, ground, angle);
  return model;
}

}  // namespace catena::testing
