#include "peer_records_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "cases/parallelogram.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "moving_mechanisms.hpp"
#include "timing.hpp"

namespace bench {

using namespace catena;

namespace {

constexpr double field_strength = 9.81;
constexpr double tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11};
constexpr IntegrationMethod methods[] = {IntegrationMethod::automatic, IntegrationMethod::rk8,
                                         IntegrationMethod::adams};

struct Run {
  AnalysisReport report;
  std::vector<std::vector<double>> rows;  ///< coordinates of every body, in the order of the model
  double energy_error = 0;                ///< J, largest against the first row
  double seconds = 0;
};

double energy(const Model& model, const SystemState& s) {
  double sum = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const auto& body = model.bodies[b];
    const double u = s.qd[3 * b], v = s.qd[3 * b + 1], w = s.qd[3 * b + 2];
    sum += 0.5 * body.mass * (u * u + v * v) + 0.5 * body.inertia * w * w + body.mass * field_strength * s.q[3 * b + 1];
  }
  return sum;
}

Run simulate(const std::shared_ptr<Model>& model, const TimeGrid& grid, const DynamicsOptions& options,
             int repeats = 3) {
  Run run;
  const auto once = [&] {
    run.rows.clear();
    double first = 0;
    Dynamics dynamics(model, {}, options);
    RowFunction keep([&](const Snapshot& row) {
      const SystemState s = state_of(row.evaluator, row.t, row.q, row.qd);
      run.rows.push_back(s.q);
      const double now = energy(*model, s);
      if (run.rows.size() == 1) first = now;
      run.energy_error = std::max(run.energy_error, std::abs(now - first));
      return true;
    });
    run.report = dynamics.run(grid, {.velocity = true}, keep);
  };
  run.seconds = least_time(repeats, 1, once);
  return run;
}

/// Far end of a rod of 1 m.
Vec2<double> far_end(const std::vector<double>& q, std::size_t b) {
  return {q[3 * b] + 0.5 * std::cos(q[3 * b + 2]), q[3 * b + 1] + 0.5 * std::sin(q[3 * b + 2])};
}

double apart(Vec2<double> a, Vec2<double> b) { return norm(a - b); }

void failed(const char* table, std::string_view method, double tolerance, const AnalysisReport& report) {
  fmt::print("{}-failed\tcatena\t{}\ttol={:.0e}\t{}\n", table, method, tolerance, report.message);
}

}  // namespace

void print_chain_records() {
  const auto model = straight_chain(40);
  const TimeGrid grid = TimeGrid::range(0, 1, 1);
  const Run exact = simulate(model, grid, {.method = IntegrationMethod::adams, .tolerance = 1e-13}, 1);
  for (IntegrationMethod method : methods) {
    for (double tolerance : tolerances) {
      const Run run = simulate(model, grid, {.method = method, .tolerance = tolerance}, 15);
      if (!run.report.ok()) {
        failed("S1b", to_string(method), tolerance, run.report);
        continue;
      }
      double worst = 0, tip = 0;
      for (std::size_t b = 0; b < 40; ++b) {
        tip = apart(far_end(run.rows.back(), b), far_end(exact.rows.back(), b));
        worst = std::max(worst, tip);
      }
      fmt::print("S1b\tcatena\t{}\ttol={:.0e}\t{}\t{:.3f}\t{:.2e}\t{:.2e}\t{:.2e}\n", to_string(method), tolerance,
                 run.report.counters.steps, 1e3 * run.seconds, run.energy_error, tip, worst);
      std::fflush(stdout);
    }
  }
}

void print_fourbar_records() {
  constexpr int samples = 400;
  constexpr double duration = 10;
  for (int n : {2, 40}) {
    const auto model = four_bars(n);
    const TimeGrid grid = TimeGrid::range(0, duration, duration / samples);
    Parallelogram parallelogram(n);
    std::vector<Vec2<double>> exact;
    for (std::int64_t k = 0; k < grid.size(); ++k) exact.push_back(parallelogram.crank_end(grid[k]));
    for (IntegrationMethod method : {IntegrationMethod::automatic, IntegrationMethod::rk8}) {
      for (double tolerance : tolerances) {
        const Run run = simulate(model, grid, {.method = method, .tolerance = tolerance}, 3);
        if (!run.report.ok() || run.rows.size() != exact.size()) {
          failed("S2", to_string(method), tolerance, run.report);
          continue;
        }
        double worst = 0, good = 0;
        for (std::size_t k = 0; k < exact.size(); ++k) {
          worst = std::max(worst, apart(far_end(run.rows[k], 0), exact[k]));
          if (worst < 0.1) good = duration * static_cast<double>(k) / samples;
        }
        fmt::print("S2\tcatena\t{}\ttol={:.0e}\t{}\t{:.3f}\t{:.2e}\t{:.2e}\t{:.2f}\n", to_string(method), tolerance, n,
                   1e3 * run.seconds, run.energy_error, worst, good);
        std::fflush(stdout);
      }
    }
  }
}

void print_squeezer_records() {
  // Angles of the Test Set at the end: beta, Theta, gamma, Phi, delta, Omega, epsilon; and what each body turned by.
  constexpr double beta = 15.81077119629904, theta = -15.75637105984298, gamma = 0.04082224013073101,
                   phi = -0.5347301163226948, delta = 0.5244099658805304, omega = 0.5347301163226948,
                   epsilon = 1.048080741042263;
  const double turned[] = {beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon};
  constexpr double beta_0 = -0.0617138900142764496, gamma_0 = 0.4552798191630703803, phi_0 = 0.2226683901658858847,
                   delta_0 = 0.4873649795438425502, epsilon_0 = 1.2305474445498211925;
  const double start[] = {beta_0, beta_0, gamma_0, phi_0 + delta_0, delta_0, epsilon_0 - phi_0, epsilon_0};
  const auto model = squeezer();
  for (IntegrationMethod method : methods) {
    for (double tolerance : tolerances) {
      const Run run = simulate(model, TimeGrid::range(0, 0.03, 0.03), {.method = method, .tolerance = tolerance}, 15);
      if (!run.report.ok()) {
        failed("S3", to_string(method), tolerance, run.report);
        continue;
      }
      double worst = 0;
      for (std::size_t b = 0; b < 7; ++b) {
        const double by = run.rows.back()[3 * b + 2] - run.rows.front()[3 * b + 2];
        worst = std::max(worst, std::abs(by - (turned[b] - start[b])));
      }
      fmt::print("S3\tcatena\t{}\ttol={:.0e}\t{}\t{:.3f}\t{:.2e}\n", to_string(method), tolerance,
                 run.report.counters.steps, 1e3 * run.seconds, worst);
      std::fflush(stdout);
    }
  }
}

}  // namespace bench
