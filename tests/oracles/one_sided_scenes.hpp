// Mechanisms that gaps hold: chains on a floor and over a drum, nets of cables; and what is checked of any of them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/elements/all.hpp"
#include "catena/elements/gap_element.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {

constexpr double gravity_of_earth = 9.81;

/// N uniform rods of `length` in all between (-half, height) and (half, height); `contact` holds at every joint.
inline std::shared_ptr<Model> chain_with_contacts(int count, double length, double half, double height, double bend,
                                                  const Contact<double>& contact, double mass = 0.1) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -gravity_of_earth};
  const double l = length / count;
  for (int k = 0; k < count; ++k) {
    const double t = (k + 0.5) / count;
    BodyValues body{.mass = mass, .inertia = mass * l * l / 12};
    body.position = {half * (2 * t - 1), height - bend * 4 * t * (1 - t)};
    body.angle = std::atan2(-bend * 4 * (1 - 2 * t), 2 * half);
    model->add_body("link" + std::to_string(k), body);
  }
  for (int k = 0; k + 1 < count; ++k) {
    model->add("", Revolute<double>{{l / 2, 0}, {-l / 2, 0}}, k, k + 1);
    Contact<double> touch = contact;
    touch.s_j = {l / 2, 0};
    model->add("contact" + std::to_string(k), touch, ground, k);
  }
  model->add("left", Revolute<double>{{-half, height}, {-l / 2, 0}}, ground, 0);
  model->add("right", Revolute<double>{{half, height}, {l / 2, 0}}, ground, count - 1);
  return model;
}

/// Free above the line y = 0.
inline Contact<double> floor_contact() {
  Contact<double> contact;
  contact.curve = Curve<double>::line({0, 0}, {1, 0});
  return contact;
}

/// Free outside of a circle.
inline Contact<double> drum_contact(const Vec2<double>& centre, double radius) {
  Contact<double> contact;
  contact.curve = Curve<double>::circle(centre, radius);
  return contact;
}

/// A gap at a solution: Psi and p.
struct GapState {
  double gap = 0, force = 0;
};

/// One state for each one-sided element, file order.
inline std::vector<GapState> gap_states(Equilibrium& analysis, const Model& model) {
  std::vector<GapState> states;
  analysis.evaluator().set_configuration(analysis.q());
  for (const int e : model.gaps()) {
    const auto row = static_cast<std::size_t>(analysis.plan().element_row[static_cast<std::size_t>(e)]);
    states.push_back({analysis.evaluator().measure(e, {}, {}).value, -analysis.lambda()[row]});
  }
  return states;
}

/// Nothing overlaps, nothing pulls, and what is open pushes nothing: products below 1e-8 of force times length.
inline void expect_complementary(const std::vector<GapState>& states, double force, double length) {
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_GE(states[k].gap, -1e-10 * length) << k;
    EXPECT_GE(states[k].force, -1e-10 * force) << k;
    EXPECT_LE(std::abs(states[k].gap * states[k].force), 1e-8 * force * length) << k;
  }
}

}  // namespace catena::testing
