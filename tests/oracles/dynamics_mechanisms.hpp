// Mechanisms whose motion is known independently, and how a test runs them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_reference.hpp"

namespace catena::testing {

/// Every method of integration that chooses its steps by a tolerance.
inline constexpr IntegrationMethod all_methods[] = {IntegrationMethod::rk8,          IntegrationMethod::rk5,
                                                    IntegrationMethod::baumgarte,    IntegrationMethod::adams,
                                                    IntegrationMethod::partitioning, IntegrationMethod::radau};

/// n uniform rods in series from the origin along +x, pinned; the last body's far end is the tip.
inline std::shared_ptr<Model> rod_chain(int n, double length = 1, double mass = 1) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  int before = ground;
  for (int k = 0; k < n; ++k) {
    const int rod =
        model->add_body("rod" + std::to_string(k + 1),
                        {.mass = mass, .inertia = mass * length * length / 12, .position = {(k + 0.5) * length, 0}});
    const Vec2<double> end = before == ground ? Vec2<double>{} : Vec2<double>{length / 2, 0};
    model->add("pin" + std::to_string(k + 1), Revolute<>{end, {-length / 2, 0}}, before, rod);
    before = rod;
  }
  return model;
}

/// IFToMM A02: n four-bars of 1 m side by side, upright, pushed to the right with 1 m/s.
inline std::shared_ptr<Model> four_bars(int n) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const auto rod = [&](const std::string& name, Vec2<double> middle, double angle, Vec2<double> v, double omega) {
    const int body = model->add_body(name, {.mass = 1, .inertia = 1.0 / 12, .position = middle, .angle = angle});
    BasicBody<double>& values = model->bodies[static_cast<std::size_t>(body)];
    values.velocity = v;
    values.angular_velocity = omega;
    values.velocity_given = values.angular_velocity_given = true;
    return body;
  };
  std::vector<int> crank;
  for (int k = 0; k <= n; ++k) {
    crank.push_back(rod("crank" + std::to_string(k), {k + 0.0, 0.5}, std::numbers::pi / 2, {0.5, 0}, -1));
    model->add("A" + std::to_string(k), Revolute<>{{k + 0.0, 0}, {-0.5, 0}}, ground, crank.back());
  }
  for (std::size_t k = 1; k < crank.size(); ++k) {
    const int bar = rod("bar" + std::to_string(k), {static_cast<double>(k) - 0.5, 1}, 0, {1, 0}, 0);
    model->add("", Revolute<>{{0.5, 0}, {-0.5, 0}}, crank[k - 1], bar);
    model->add("", Revolute<>{{0.5, 0}, {0.5, 0}}, crank[k], bar);
  }
  return model;
}

/// Andrews' squeezing mechanism as the Test Set for IVP Solvers defines it, with beta0 of that definition.
inline std::shared_ptr<Model> squeezer() {
  struct Part {
    const char* name;
    double mass, inertia, x, y, angle;
  };
  constexpr Part parts[] = {
      {"K1", 0.04325, 2.194e-6, 0.0009182485980307614, -5.674074562905483e-05, -0.06171389001427645},
      {"K2", 0.00365, 4.41e-7, -0.0044914333599330725, 0.0002775362557942899, -0.06171389001427645},
      {"K3", 0.02373, 5.255e-6, -0.018742186670315457, 0.020485106789073934, 0.45527981916307037},
      {"K4", 0.00706, 5.667e-7, -0.030222939830158887, 0.012071182356663938, 0.7100333697097284},
      {"K5", 0.0705, 1.169e-5, -0.05323682815570414, 0.016631847966616306, 0.48736497954384256},
      {"K6", 0.00706, 5.667e-7, -0.028543268536783597, -0.010722254707252287, 1.0078790543839353},
      {"K7", 0.05498, 1.912e-5, -0.059262402801791715, -0.010600698332712844, 1.2305474445498212}};
  auto model = std::make_shared<Model>();
  for (const Part& p : parts) {
    model->add_body(p.name, {.mass = p.mass, .inertia = p.inertia, .position = {p.x, p.y}, .angle = p.angle});
  }
  const auto pin = [&](int i, Vec2<double> s_i, int j, Vec2<double> s_j) {
    model->add("", Revolute<>{s_i, s_j}, i, j);
  };
  pin(ground, {0, 0}, 0, {-0.00092, 0});
  pin(0, {0.00608, 0}, 1, {0.0115, 0});
  pin(1, {-0.0165, 0}, 2, {-0.01043, -0.01626});
  pin(2, {-0.01043, -0.01626}, 3, {0, -0.01421});
  pin(3, {0, -0.01421}, 5, {0.01421, 0});
  pin(ground, {-0.03635, 0.03273}, 2, {-0.01043, 0.01874});
  pin(3, {0, 0.00579}, 4, {0.01692, -0.00916});
  pin(ground, {-0.06934, -0.00227}, 4, {-0.02308, -0.00916});
  pin(ground, {-0.06934, -0.00227}, 6, {0.00449, 0.01228});
  pin(5, {-0.00579, 0}, 6, {0.00449, -0.02772});
  model->add_force("motor", Torque<>{}, 0, ground, {TimeFunction<double>(0.033)});
  SpringDamper<> spring;
  spring.s_i = {0.014, 0.072};
  spring.s_j = {0.00957, 0.00074};
  spring.k = 4530;
  spring.length = 0.07785;
  model->add_force("spring", spring, ground, 2);
  return model;
}

/// Runs and calls f(snapshot) at every row; the analysis must succeed.
template <class F>
AnalysisReport run_dynamics(Dynamics& dynamics, const TimeGrid& grid, const Needs& needs, F&& f) {
  RowFunction rows([&](const Snapshot& s) {
    f(s);
    return true;
  });
  const AnalysisReport report = dynamics.run(grid, needs, rows);
  EXPECT_TRUE(report.ok()) << to_string(report.status) << ": " << report.message;
  return report;
}

/// Frame of a body of the model.
inline Frame<double> frame_of(const Snapshot& s, int body) {
  return s.evaluator.ground_frame(s.evaluator.plan().plan_body[static_cast<std::size_t>(body)]);
}
/// Velocity [vx, vy, omega] or acceleration of a body of the model.
inline const double* rates_of(const Snapshot& s, std::span<const double> of, int body) {
  return of.data() + 3 * s.evaluator.plan().plan_body[static_cast<std::size_t>(body)];
}

}  // namespace catena::testing
