// User-defined forces and equations against the elements that they imitate, and against known motions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/elements/constraints/custom_constraint.hpp"
#include "catena/elements/forces/custom_force.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "catena/results/result_storage.hpp"
#include "elements/random_element.hpp"

namespace catena {
namespace {

/// A linear spring and damper written by hand.
struct HandmadeSpring {
  double k, c, length;

  template <class T>
  Vec2<T> span(const ForceArguments<T>& a) const {
    return {a.j.x - a.i.x, a.j.y - a.i.y};
  }
  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const Vec2<T> h = span(a);
    const T l = norm(h);
    const T rate = dot(h, Vec2<T>{a.v.vx - a.u.vx, a.v.vy - a.u.vy}) / l;
    const Vec2<T> pull = ((T(k) * (l - T(length)) + T(c) * rate + a.f[0]) / l) * h;
    add_force_at(Vec2<T>{}, pull, on_i);
    add_force_at(Vec2<T>{}, -pull, on_j);
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const T l = norm(span(a)), stretch = l - T(length);
    return T(k / 2) * stretch * stretch + a.f[0] * l;
  }
};

/// Attraction mu / distance^2, without a potential of its own.
struct Attraction {
  double mu;
  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const Vec2<T> h{a.j.x - a.i.x, a.j.y - a.i.y};
    const Vec2<T> pull = (T(mu) / (squared_norm(h) * norm(h))) * h;
    add_force_at(Vec2<T>{}, pull, on_i);
    add_force_at(Vec2<T>{}, -pull, on_j);
  }
};

/// Keeps the centroid of j on the parabola y' = a x'^2 of body i.
struct OnParabola {
  double a;
  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    const T x = j.x - i.x, y = j.y - i.y, along = i.c * x + i.s * y, across = i.c * y - i.s * x;
    return across - T(a) * along * along;
  }
};

Model two_masses() {
  Model model;
  model.add_body("a", {.mass = 2, .inertia = 0.3, .position = {0.1, -0.2}, .angle = 0.4});
  model.add_body("b", {.mass = 1, .inertia = 0.1, .position = {1.3, 0.7}, .angle = -0.8});
  return model;
}

TEST(CustomForce, ActsAsTheSpringItImitates) {
  const double growing[] = {1.0, 2.0};
  const auto add = [&](Model& model, const auto& element) {
    model.add_force("S", element, 0, 1, {TimeFunction<double>::polynomial(growing)});
  };
  Model by_hand = two_masses(), built_in = two_masses();
  add(by_hand, custom_force(HandmadeSpring{30, 4, 0.5}));
  add(built_in, SpringDamper<double>{{}, {}, 30, 4, 0.5});
  const std::vector<double> qd{0.3, -0.4, 1, 0.8, 0.2, -2, 0, 0, 0};
  std::array<std::vector<double>, 2> Q;
  std::array<double, 2> potential{}, load{};
  std::array<std::array<double, 36>, 2> stiffness{};
  for (std::size_t k = 0; k < 2; ++k) {
    const Model& model = k == 0 ? by_hand : built_in;
    EvaluationWork work;
    Evaluator evaluator(Plan::make(model), model, work);
    evaluator.set_time(0.7);
    evaluator.set_configuration(evaluator.given_configuration());
    Q[k].resize(9);
    evaluator.applied_forces(qd, Q[k]);
    potential[k] = evaluator.potential_energy();
    // The handmade law has no dissipation of its own: what it loses counts as work of a load.
    load[k] = evaluator.load_power(qd) - evaluator.dissipation(qd);
    evaluator.visit_stiffness(qd, [&](int, int, const ElementMatrix& matrix) { stiffness[k] = matrix; });
    EXPECT_TRUE(evaluator.conservative());
  }
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(Q[0][k], Q[1][k], 1e-13) << k;
  for (std::size_t k = 0; k < 36; ++k) EXPECT_NEAR(stiffness[0][k], stiffness[1][k], 1e-12) << k;
  EXPECT_NEAR(potential[0], potential[1], 1e-13);
  EXPECT_NEAR(load[0], load[1], 1e-12);
}

// Kepler: after 2 pi sqrt(a^3 / mu) an orbit closes.
TEST(CustomForce, KeepsAPlanetOnItsEllipse) {
  constexpr double mu = 1.7, far = 2, speed = 0.6;  // at the greatest distance
  const double axis = 1 / (2 / far - speed * speed / mu);
  const double period = 2 * std::numbers::pi * std::sqrt(axis * axis * axis / mu);
  Model model;
  const int planet = model.add_body("planet", {.mass = 1, .inertia = 1, .position = {far, 0}});
  model.bodies[0].velocity = {0, speed};
  model.bodies[0].velocity_given = true;
  model.add_force("sun", custom_force(Attraction{mu}), planet, ground);
  Dynamics dynamics(std::make_shared<Model>(model), {}, {.tolerance = 1e-11});
  RowFunction rows([](const Snapshot&) { return true; });
  const AnalysisReport report = dynamics.run(TimeGrid::range(0, period, period), {.velocity = true}, rows);
  ASSERT_TRUE(report.ok()) << report.message;
  const SystemState end = dynamics.state();
  EXPECT_NEAR(end.q[0], far, 1e-9);
  EXPECT_NEAR(end.q[1], 0, 1e-9);
  EXPECT_NEAR(end.qd[0], 0, 1e-9);
  EXPECT_NEAR(end.qd[1], speed, 1e-9);
}

// A bead on a wire: (1 + 4 a^2 x^2) xdd + 4 a^2 x xd^2 + 2 a g x = 0, integrated here by Runge and Kutta's own scheme.
TEST(CustomConstraint, KeepsABeadOnItsWire) {
  constexpr double a = 0.8, g = 9.81, start = 1.1, end = 1.5;
  const auto acceleration = [](double x, double v) {
    return -(4 * a * a * x * v * v + 2 * a * g * x) / (1 + 4 * a * a * x * x);
  };
  double x = start, v = 0;
  constexpr int steps = 30000;
  for (int k = 0; k < steps; ++k) {
    constexpr double h = end / steps;
    const double k1 = v, l1 = acceleration(x, v);
    const double k2 = v + h / 2 * l1, l2 = acceleration(x + h / 2 * k1, k2);
    const double k3 = v + h / 2 * l2, l3 = acceleration(x + h / 2 * k2, k3);
    const double k4 = v + h * l3, l4 = acceleration(x + h * k3, k4);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    v += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
  }

  Model model;
  model.gravity = {0, -g};
  const int bead = model.add_body("bead", {.mass = 0.3, .inertia = 1e-3, .position = {start, a * start * start}});
  model.add("wire", custom_constraint(OnParabola{a}), ground, bead, 0.0);
  Dynamics dynamics(std::make_shared<Model>(model), {}, {.tolerance = 1e-11});
  RowFunction rows([](const Snapshot&) { return true; });
  const AnalysisReport report = dynamics.run(TimeGrid::range(0, end, end), {.velocity = true}, rows);
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_NEAR(dynamics.state().q[0], x, 1e-9);
  EXPECT_NEAR(dynamics.state().q[1], a * x * x, 1e-9);
  EXPECT_NEAR(dynamics.state().qd[0], v, 1e-8);
}

TEST(CustomLaws, NeedALaw) {
  Model model = two_masses();
  EXPECT_THROW(model.add_force("F", CustomForce<double>{}, 0, 1), ModelError);
  EXPECT_THROW(model.add("C", CustomConstraint<double>{}, 0, 1, 0.0), ModelError);
}

}  // namespace
}  // namespace catena
