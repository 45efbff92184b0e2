// Mechanisms whose small oscillations are known in closed form.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_scenes.hpp"

namespace catena::testing {

/// N rods of 1 m and 1 kg in a line from a pin at the origin: hanging (direction -1) or standing on it (+1).
inline std::shared_ptr<Model> vertical_chain(int count, int direction) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  for (int k = 0; k < count; ++k) {
    model->add_body("rod" + std::to_string(k + 1), {.mass = 1,
                                                    .inertia = 1 / 12.0,
                                                    .position = {0, direction * (k + 0.5)},
                                                    .angle = direction * std::numbers::pi / 2});
  }
  for (int k = 0; k < count; ++k) {
    model->add("", Revolute<double>{.s_i = {k == 0 ? 0 : 0.5, 0}, .s_j = {-0.5, 0}}, k - 1, k);
  }
  return model;
}

/// N masses of 1 kg that do not turn on massless links of 1 m, hanging from the origin.
inline std::shared_ptr<Model> hanging_masses(int count) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  for (int k = 0; k < count; ++k) {
    model->add_body("ball" + std::to_string(k + 1), {.mass = 1, .position = {0, -1.0 - k}, .particle = true});
  }
  model->add("top", AbsoluteDistance<double>{}, 0, ground, 1.0);
  for (int k = 1; k < count; ++k) model->add("", Coupler<double>{}, k - 1, k, 1.0);
  return model;
}

/// N masses of 1.5 kg on a line with springs of 200 N/m between them, the first one tied to the ground, the last one
/// too if `fixed_end`.
inline std::shared_ptr<Model> spring_mass_chain(int count, bool fixed_end) {
  auto model = std::make_shared<Model>();
  for (int k = 0; k < count; ++k) {
    model->add_body("mass" + std::to_string(k + 1), {.mass = 1.5, .position = {k + 1.0, 0}, .particle = true});
    model->add("", AbsoluteY<double>{}, k, ground, 0.0);
  }
  for (int k = 0; k < count; ++k) model->add_force("", spring({0, 0}, {0, 0}, 200, 1), k - 1, k);
  if (fixed_end) model->add_force("", spring({0, 0}, {count + 1.0, 0}, 200, 1), count - 1, ground);
  return model;
}

/// N discs of 0.1 kg m^2 on a shaft, fixed in place but free to turn, torsion springs of 40 N m/rad between them.
inline std::shared_ptr<Model> torsion_chain(int count) {
  auto model = std::make_shared<Model>();
  for (int k = 0; k < count; ++k) {
    model->add_body("disc" + std::to_string(k + 1), {.mass = 1, .inertia = 0.1, .position = {0.2 * k, 0}});
    model->add("", Revolute<double>{.s_i = {0.2 * k, 0}, .s_j = {0, 0}}, ground, k);
    if (k > 0) model->add_force("", torsion_spring(40, 0), k - 1, k);
  }
  return model;
}

/// N equal rods of 1 m and 1 kg, each on a pin of its own.
inline std::shared_ptr<Model> equal_pendulums(int count) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  for (int k = 0; k < count; ++k) {
    model->add_body("rod" + std::to_string(k + 1),
                    {.mass = 1, .inertia = 1 / 12.0, .position = {2.0 * k, -0.5}, .angle = -std::numbers::pi / 2});
    model->add("", Revolute<double>{.s_i = {2.0 * k, 0}, .s_j = {-0.5, 0}}, ground, k);
  }
  return model;
}

}  // namespace catena::testing
