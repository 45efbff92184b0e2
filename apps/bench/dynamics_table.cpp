#include "dynamics_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "catena/analysis/dynamics.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/model/model_add.hpp"
#include "mechanisms.hpp"
#include "timing.hpp"

namespace bench {

using namespace catena;

namespace {

/// n uniform rods of 1 m and 1 kg in a straight horizontal line, at rest.
std::shared_ptr<Model> straight_chain(int n) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  for (int k = 0; k < n; ++k) {
    const int rod =
        model->add_body("rod" + std::to_string(k), {.mass = 1, .inertia = 1.0 / 12, .position = {k + 0.5, 0}});
    model->add("", Revolute<>{{k == 0 ? 0 : 0.5, 0}, {-0.5, 0}}, k == 0 ? ground : rod - 1, rod);
  }
  return model;
}

/// IFToMM A02: n four-bars of 1 m side by side, upright, pushed to the right with 1 m/s.
std::shared_ptr<Model> four_bars(int n) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const auto rod = [&](const std::string& name, Vec2<double> middle, double angle, double speed, double omega) {
    const int body = model->add_body(name, {.mass = 1, .inertia = 1.0 / 12, .position = middle, .angle = angle});
    BasicBody<double>& values = model->bodies[static_cast<std::size_t>(body)];
    values.velocity = {speed, 0};
    values.angular_velocity = omega;
    values.velocity_given = values.angular_velocity_given = true;
    return body;
  };
  int before = -1;
  for (int k = 0; k <= n; ++k) {
    const int crank = rod("crank" + std::to_string(k), {k + 0.0, 0.5}, std::numbers::pi / 2, 0.5, -1);
    model->add("", Revolute<>{{k + 0.0, 0}, {-0.5, 0}}, ground, crank);
    if (k > 0) {
      const int bar = rod("bar" + std::to_string(k), {k - 0.5, 1}, 0, 1, 0);
      model->add("", Revolute<>{{0.5, 0}, {-0.5, 0}}, before, bar);
      model->add("", Revolute<>{{0.5, 0}, {0.5, 0}}, crank, bar);
    }
    before = crank;
  }
  return model;
}

/// Andrews' squeezing mechanism as the Test Set for IVP Solvers defines it.
std::shared_ptr<Model> squeezer() {
  struct Part {
    double mass, inertia, x, y, angle;
  };
  constexpr Part parts[] = {{0.04325, 2.194e-6, 0.0009182485980307614, -5.674074562905483e-05, -0.06171389001427645},
                            {0.00365, 4.41e-7, -0.0044914333599330725, 0.0002775362557942899, -0.06171389001427645},
                            {0.02373, 5.255e-6, -0.018742186670315457, 0.020485106789073934, 0.45527981916307037},
                            {0.00706, 5.667e-7, -0.030222939830158887, 0.012071182356663938, 0.7100333697097284},
                            {0.0705, 1.169e-5, -0.05323682815570414, 0.016631847966616306, 0.48736497954384256},
                            {0.00706, 5.667e-7, -0.028543268536783597, -0.010722254707252287, 1.0078790543839353},
                            {0.05498, 1.912e-5, -0.059262402801791715, -0.010600698332712844, 1.2305474445498212}};
  auto model = std::make_shared<Model>();
  for (const Part& p : parts) {
    model->add_body("K" + std::to_string(model->bodies.size() + 1),
                    {.mass = p.mass, .inertia = p.inertia, .position = {p.x, p.y}, .angle = p.angle});
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

/// Coordinates at the rows of a run.
std::vector<double> coordinates(const std::shared_ptr<Model>& model, const TimeGrid& grid,
                                const DynamicsOptions& options, AnalysisReport* report) {
  std::vector<double> rows;
  Dynamics dynamics(model, {}, options);
  RowFunction keep([&](const Snapshot& s) {
    rows.insert(rows.end(), s.q.begin(), s.q.end());
    return true;
  });
  *report = dynamics.run(grid, {}, keep);
  return rows;
}

/// `angles`: whether errors are those of angles, rad, or of places, m; `least`: tolerance of the reference.
void error_table(const char* title, const std::shared_ptr<Model>& model, const TimeGrid& grid, bool angles,
                 double least = 1e-13) {
  AnalysisReport report;
  const std::vector<double> exact = coordinates(model, grid, {.tolerance = least}, &report);
  fmt::print("\n{}\n{:>12} {:>10} {:>12} {:>8} {:>10} {:>10}\n", title, "method", "tolerance",
             angles ? "error, rad" : "error, m", "steps", "evaluated", "ms");
  // All but the first, which chooses one of the others.
  for (std::size_t m = 1; m < integration_methods.size(); ++m) {
    const auto method = static_cast<IntegrationMethod>(m);
    for (double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
      if (tolerance < 10 * least) continue;
      const DynamicsOptions options{.method = method, .tolerance = tolerance};
      const std::vector<double> rows = coordinates(model, grid, options, &report);
      if (!report.ok() || rows.size() != exact.size()) {
        fmt::print("{:>12} {:10.0e} {}\n", to_string(method), tolerance, report.message);
        continue;
      }
      double error = 0;
      for (std::size_t c = 0; c < rows.size(); ++c) {
        if ((c % 3 == 2) == angles) error = std::max(error, std::abs(rows[c] - exact[c]));
      }
      const double time = least_time(3, 1, [&] { coordinates(model, grid, options, &report); });
      fmt::print("{:>12} {:10.0e} {:12.2e} {:8} {:10} {:10.3f}\n", to_string(method), tolerance, error,
                 report.counters.steps, report.counters.forces, 1e3 * time);
    }
  }
}

}  // namespace

void print_acceleration_costs() {
  fmt::print("\nAccelerations of a chain of rods (trigonometry, Jacobian, factors, solve), ns a body.\n{:>8} {:>10}\n",
             "bodies", "ns");
  for (int n : {100, 1000, 10000, 100000, 1000000}) {
    const auto model = chain(n);
    Evaluator evaluator(Plan::make(*model), *model);
    EquationsOfMotion equations(evaluator);
    if (!equations.use_masses().ok()) continue;
    const std::vector<double> q = evaluator.given_configuration();
    std::vector<double> qd(q.size()), qdd(q.size());
    for (std::size_t k = 0; k < qd.size(); ++k) qd[k] = 0.1 * std::cos(static_cast<double>(k));
    bool ok = equations.accelerations(0, Side::after, q, qd, qdd);
    const double time =
        least_time(7, std::max(1, 20000 / n), [&] { ok = ok && equations.accelerations(0, Side::after, q, qd, qdd); });
    fmt::print("{:8} {:10.1f}{}\n", n, 1e9 * time / n, ok ? "" : "  failed");
  }
}

void print_dynamic_errors() {
  error_table("A chain of 40 rods of 1 m falls for 1 s, worst place of any rod's middle:", straight_chain(40),
              TimeGrid::instant(1), false);
  error_table("Forty four-bars for 10 s, through the flat position some ten times, worst place:", four_bars(40),
              TimeGrid::range(0, 10, 0.5), false, 1e-11);
  error_table("Andrews' squeezing mechanism to 0.03 s, worst angle:", squeezer(), TimeGrid::instant(0.03), true);
}

}  // namespace bench
