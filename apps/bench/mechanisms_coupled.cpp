// Mechanisms of many loops, cams or gears.
#include <cmath>
#include <string>

#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/cam_flat.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/model/model_add.hpp"
#include "mechanisms.hpp"

namespace bench {

using namespace catena;

namespace {

std::string coupled_name(const char* kind, int k) { return kind + std::to_string(k); }

TimeFunction<double> swing(double middle, double amplitude) {
  return TimeFunction<double>::harmonic(amplitude, 1.5, 0, middle);
}

int add_wheel(Model& model, const std::string& label, Vec2<double> centre) {
  const int wheel = model.add_body(label, {.mass = 1, .inertia = 0.01, .position = centre});
  model.add("bearing_" + label, Revolute<>{centre, {0, 0}}, ground, wheel);
  return wheel;
}

}  // namespace

std::shared_ptr<Model> lattice(int side) {
  auto model = std::make_shared<Model>();
  const double lean = 0.3;
  const auto node = [&](int column, int row) {
    return Vec2<double>{column - row * std::sin(lean), row * std::cos(lean)};
  };
  const int wall = add_rod(*model, "wall", node(0, 0), node(0, side));
  model->add("O", Revolute<>{{0, 0}, {-0.5 * side, 0}}, ground, wall);
  // Level and upright rods that meet in node (column, row), by the number of the upright one; column 0 is the wall.
  std::vector<int> upright(static_cast<std::size_t>(side + 1), -1);
  int last = wall;
  for (int row = 1; row <= side; ++row) {
    for (int column = 1; column <= side; ++column) {
      const std::string at = std::to_string(column) + "_" + std::to_string(row);
      const int level = add_rod(*model, "level" + at, node(column - 1, row), node(column, row));
      const int rod = add_rod(*model, "upright" + at, node(column, row - 1), node(column, row));
      if (column == 1) {
        model->add("L" + at, Revolute<>{{row - 0.5 * side, 0}, {-0.5, 0}}, wall, level);
      } else {
        model->add("L" + at, Revolute<>{{0.5, 0}, {-0.5, 0}}, last, level);
      }
      int& below = upright[static_cast<std::size_t>(column)];
      if (row == 1) {
        model->add("U" + at, Revolute<>{node(column, 0), {-0.5, 0}}, ground, rod);
      } else {
        model->add("U" + at, Revolute<>{{0.5, 0}, {-0.5, 0}}, below, rod);
      }
      model->add("N" + at, Revolute<>{{0.5, 0}, {0.5, 0}}, level, rod);
      below = last = rod;
    }
  }
  // Driven where it is farthest from the ground and the wall, no part of it can be solved by itself.
  model->add_driver("drive", AbsoluteAngle<>{}, last, ground, swing(1.5707963267948966 + lean, 0.2));
  return model;
}

std::shared_ptr<Model> camshaft(int cams) {
  auto model = std::make_shared<Model>();
  int previous = -1;
  for (int k = 0; k < cams; ++k) {
    const Vec2<double> centre{0.1 * k, 0};
    const int cam = add_wheel(*model, coupled_name("cam", k), centre);
    const double phase = 0.7 * k, offset = 0.01, radius = 0.03;
    const Vec2<double> eccentric{offset * std::cos(phase), offset * std::sin(phase)};
    const int follower = model->add_body(coupled_name("follower", k),
                                         {.mass = 1, .inertia = 0.01, .position = {centre.x, eccentric.y + radius}});
    model->add(coupled_name("guide", k), Translational<>{.s_i = centre, .axis_i = {0, 1}, .axis_j = {0, 1}}, ground,
               follower);
    model->add(coupled_name("contact", k),
               CamFlat<>{.axis_j = {1, 0}, .curve = Curve<double>::circle(eccentric, radius)}, cam, follower);
    if (k > 0) model->add(coupled_name("shaft", k), RelativeAngle<>{}, previous, cam, 0.0);
    previous = cam;
  }
  model->add_driver("drive", AbsoluteAngle<>{}, 0, ground, swing(0, 0.5));
  return model;
}

std::shared_ptr<Model> gear_train(int gears) {
  auto model = std::make_shared<Model>();
  double x = 0;
  for (int k = 0; k < gears; ++k) {
    const double radius = k % 2 ? 0.04 : 0.06;
    add_wheel(*model, coupled_name("gear", k), {x, 0});
    if (k > 0) model->add(coupled_name("mesh", k), Gear<>{.radius_i = 0.1 - radius, .radius_j = radius}, k - 1, k);
    x += 0.1;
  }
  model->add_driver("drive", AbsoluteAngle<>{}, 0, ground, swing(0, 0.5));
  return model;
}

}  // namespace bench
