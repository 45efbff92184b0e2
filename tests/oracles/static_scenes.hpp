// Mechanisms whose equilibria are known in closed form, and ways to start from far off them.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {

constexpr double earth = 9.81;

inline TorsionSpring<double> torsion_spring(double k, double angle) {
  TorsionSpring<double> spring;
  spring.k = k;
  spring.angle = angle;
  return spring;
}

inline SpringDamper<double> spring(const Vec2<double>& i, const Vec2<double>& j, double k, double length) {
  SpringDamper<double> element;
  element.s_i = i;
  element.s_j = j;
  element.k = k;
  element.length = length;
  return element;
}

/// How a chain is laid out before its equilibrium is looked for; positions need not meet the joints.
enum class ChainStart { sag, zigzag, above, reversed, straight, vertical, random_walk, scattered };

/// N uniform rods between pins at (0, 0) and (span, 0): the discrete catenary.
inline std::shared_ptr<Model> hanging_chain(int count, ChainStart start, unsigned seed = 1, double length = 1.5,
                                            double mass = 1, double span = 1) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  const double l = length / count, m = mass / count;
  std::mt19937 random(seed);
  const auto uniform = [&] { return (static_cast<double>(random()) / 4294967296.0 * 2 - 1) * std::numbers::pi; };
  Vec2<double> end{};
  for (int k = 0; k < count; ++k) {
    const double t = (k + 0.5) / count;
    BodyValues body{.mass = m, .inertia = m * l * l / 12};
    switch (start) {
      case ChainStart::sag:
        body.angle = 2.6 * (t - 0.5);
        body.position = {span * t, -span * t * (1 - t)};
        break;
      case ChainStart::zigzag:
        body.angle = (k % 2 ? -1 : 1) * std::acos(span / length);
        body.position = {span * t, 0};
        break;
      case ChainStart::above:
        body.position = {span * t, span};
        break;
      case ChainStart::reversed:
        body.angle = std::numbers::pi + 0.3 * (t - 0.5);
        body.position = {span * t, 0};
        break;
      case ChainStart::straight:
        body.position = {span * t, 0};
        break;
      case ChainStart::vertical:
        body.angle = std::numbers::pi / 2;
        body.position = {0, (k + 0.5) * l};
        break;
      case ChainStart::random_walk: {
        body.angle = uniform();
        const Vec2<double> step = l * Vec2<double>{std::cos(body.angle), std::sin(body.angle)};
        body.position = end + 0.5 * step;
        end += step;
        break;
      }
      case ChainStart::scattered:
        body.angle = uniform();
        body.position = {uniform(), uniform()};
        break;
    }
    model->add_body("link" + std::to_string(k + 1), body);
  }
  model->add("left", Revolute<double>{.s_i = {0, 0}, .s_j = {-l / 2, 0}}, ground, 0);
  for (int k = 1; k < count; ++k) {
    model->add("pin" + std::to_string(k), Revolute<double>{.s_i = {l / 2, 0}, .s_j = {-l / 2, 0}}, k - 1, k);
  }
  model->add("right", Revolute<double>{.s_i = {span, 0}, .s_j = {l / 2, 0}}, ground, count - 1);
  return model;
}

/// N rods hanging from a pin at the origin, straight down, with a horizontal force on the free end.
inline std::shared_ptr<Model> chain_with_side_force(int count, double length, double mass, double force) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  const double l = length / count, m = mass / count;
  for (int k = 0; k < count; ++k) {
    model->add_body(
        "rod" + std::to_string(k + 1),
        {.mass = m, .inertia = m * l * l / 12, .position = {0, -(k + 0.5) * l}, .angle = -std::numbers::pi / 2});
  }
  model->add("top", Revolute<double>{.s_i = {0, 0}, .s_j = {-l / 2, 0}}, ground, 0);
  for (int k = 1; k < count; ++k) {
    model->add("", Revolute<double>{.s_i = {l / 2, 0}, .s_j = {-l / 2, 0}}, k - 1, k);
  }
  model->add_force("tip", PointForce<double>{.s_i = {l / 2, 0}}, count - 1, ground, {force, 0.0});
  return model;
}

/// A cantilever of N massless rods with torsion springs N at the joints (2 N at the clamp), a load of 10 N down at its
/// tip; total length 1 m. Laid out along an arc that misses the joints a little.
inline std::shared_ptr<Model> elastica_chain(int count) {
  auto model = std::make_shared<Model>();
  const double l = 1.0 / count, bend = -1.2;
  for (int k = 1; k <= count; ++k) {
    model->add_body("rod" + std::to_string(k),
                    {.mass = 0,
                     .inertia = 0,
                     .position = {(k - 0.5) * l * (1 - bend * bend / 6), bend * l * k * k / (2 * count)},
                     .angle = bend * k / count});
  }
  for (int k = 0; k < count; ++k) {
    model->add(k == 0 ? "root" : "", Revolute<double>{.s_i = {k == 0 ? 0 : l / 2, 0}, .s_j = {-l / 2, 0}}, k - 1, k);
    model->add_force("", torsion_spring(k == 0 ? 2.0 * count : count, 0), k - 1, k);
  }
  model->add_force("tip", PointForce<double>{.s_i = {l / 2, 0}}, count - 1, ground, {0.0, -10.0});
  return model;
}

/// A bar of 1 m above a pin, its mass at the free end, held upright by a torsion spring of 1 N m/rad.
inline std::shared_ptr<Model> inverted_pendulum(double weight_times_length, double angle = 0) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  model->add_body("bar", {.mass = weight_times_length / earth,
                          .inertia = 0,
                          .position = {-std::sin(angle), std::cos(angle)},
                          .angle = angle});
  model->add("pin", Revolute<double>{.s_i = {0, 0}, .s_j = {0, -1}}, ground, 0);
  model->add_force("spring", torsion_spring(1, 0), ground, 0);
  return model;
}

/// Three uniform rods of 1 m and 1 kg as a parallelogram on pins at (0, 0) and (1, 0), a spring along its diagonal.
inline std::shared_ptr<Model> sprung_parallelogram(double theta) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  const double c = std::cos(theta), s = std::sin(theta);
  model->add_body("left", {.mass = 1, .inertia = 1 / 12.0, .position = {c / 2, s / 2}, .angle = theta});
  model->add_body("right", {.mass = 1, .inertia = 1 / 12.0, .position = {1 + c / 2, s / 2}, .angle = theta});
  model->add_body("coupler", {.mass = 1, .inertia = 1 / 12.0, .position = {0.5 + c, s}});
  model->add("A", Revolute<double>{.s_i = {0, 0}, .s_j = {-0.5, 0}}, ground, 0);
  model->add("D", Revolute<double>{.s_i = {1, 0}, .s_j = {-0.5, 0}}, ground, 1);
  model->add("B", Revolute<double>{.s_i = {0.5, 0}, .s_j = {-0.5, 0}}, 0, 2);
  model->add("C", Revolute<double>{.s_i = {0.5, 0}, .s_j = {0.5, 0}}, 1, 2);
  model->add_force("spring", spring({0, 0}, {0.5, 0}, 25, 0.5), ground, 2);
  return model;
}

/// Two springs of 1000 N/m from pins at (-1, 0) and (1, 0) to an apex that moves along y, loaded downwards.
inline std::shared_ptr<Model> von_mises_truss(double load, double y) {
  auto model = std::make_shared<Model>();
  model->add_body("apex", {.mass = 1, .inertia = 1, .position = {0, y}});
  model->add("symmetry", AbsoluteX<double>{}, 0, ground, 0.0);
  model->add("flat", AbsoluteAngle<double>{}, 0, ground, 0.0);
  for (const double side : {-1.0, 1.0}) {
    model->add_force(side < 0 ? "left" : "right", spring({side, 0}, {0, 0}, 1000, 1.044030650891055), ground, 0);
  }
  model->add_force("load", PointForce<double>{}, 0, ground, {0.0, -load});
  return model;
}

/// Two uniform rods of 2 m and 10 kg leaning against each other at `angle` from the horizontal, 100 N down at the apex.
inline std::shared_ptr<Model> three_hinged_frame(double angle) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  const double c = std::cos(angle), s = std::sin(angle), inertia = 10 * 4 / 12.0;
  model->add_body("left", {.mass = 10, .inertia = inertia, .position = {c, s}, .angle = angle});
  model->add_body("right", {.mass = 10, .inertia = inertia, .position = {3 * c, s}, .angle = -angle});
  model->add("A", Revolute<double>{.s_i = {0, 0}, .s_j = {-1, 0}}, ground, 0);
  model->add("B", Revolute<double>{.s_i = {4 * c, 0}, .s_j = {1, 0}}, ground, 1);
  model->add("C", Revolute<double>{.s_i = {1, 0}, .s_j = {-1, 0}}, 0, 1);
  model->add_force("load", PointForce<double>{.s_i = {1, 0}}, 0, ground, {0.0, -100.0});
  return model;
}

}  // namespace catena::testing
