#include "dynamics_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "cases/parallelogram.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "mechanisms.hpp"
#include "moving_mechanisms.hpp"
#include "timing.hpp"

namespace bench {

using namespace catena;

namespace {

/// The measured quantities of a run: rows of some of its coordinates.
using Measure = std::function<void(const Snapshot&, std::vector<double>&)>;

void places(const Snapshot& s, std::vector<double>& row) {
  for (std::size_t c = 0; c < s.q.size(); ++c) {
    if (c % 3 < 2) row.push_back(s.q[c]);
  }
}

void angles(const Snapshot& s, std::vector<double>& row) {
  for (std::size_t c = 2; c < s.q.size(); c += 3) row.push_back(s.q[c]);
}

void first_crank_end(const Snapshot& s, std::vector<double>& row) {
  const Vec2<double> end = s.evaluator.ground_frame(0).point(Vec2<double>{0.5, 0});
  row.insert(row.end(), {end.x, end.y});
}

std::vector<double> rows_of(const std::shared_ptr<Model>& model, const TimeGrid& grid, const DynamicsOptions& options,
                            const Measure& measure, AnalysisReport& report, IntegrationMethod* method = nullptr) {
  std::vector<double> rows;
  Dynamics dynamics(model, {}, options);
  RowFunction keep([&](const Snapshot& s) {
    measure(s, rows);
    return true;
  });
  report = dynamics.run(grid, {}, keep);
  if (method) *method = dynamics.method();
  return rows;
}

/// Errors against `exact`.
void error_table(const char* title, const std::shared_ptr<Model>& model, const TimeGrid& grid, const Measure& measure,
                 const std::vector<double>& exact) {
  constexpr double brief = 0.1;  // runs shorter than this, s, are repeated
  fmt::print("\n{}\n{:>12} {:>10} {:>10} {:>8} {:>10} {:>10}\n", title, "method", "tolerance", "error", "steps",
             "evaluated", "ms");
  for (std::size_t m = 0; m < integration_methods.size(); ++m) {
    const auto asked = static_cast<IntegrationMethod>(m);
    if (!follows_tolerance(asked)) continue;
    for (int digits = 3; digits <= 12; ++digits) {
      const DynamicsOptions options{.method = asked, .tolerance = std::pow(10, -digits)};
      AnalysisReport report;
      IntegrationMethod method = asked;
      const double start = processor_time();
      const std::vector<double> rows = rows_of(model, grid, options, measure, report, &method);
      double time = processor_time() - start;
      const std::string label =
          asked == method ? std::string(to_string(asked)) : fmt::format("{}: {}", to_string(asked), to_string(method));
      if (!report.ok() || rows.size() != exact.size()) {
        fmt::print("{:>12} {:10.0e} {}\n", label, options.tolerance, report.message);
        continue;
      }
      double error = 0;
      for (std::size_t c = 0; c < rows.size(); ++c) error = std::max(error, std::abs(rows[c] - exact[c]));
      if (time < brief) time = least_time(3, 1, [&] { rows_of(model, grid, options, measure, report); });
      fmt::print("{:>12} {:10.0e} {:10.2e} {:8} {:10} {:10.3f}\n", label, options.tolerance, error,
                 report.counters.steps, report.counters.forces, 1e3 * time);
    }
  }
}

/// The same against a run at 1e-13.
void error_table(const char* title, const std::shared_ptr<Model>& model, const TimeGrid& grid, const Measure& measure) {
  AnalysisReport report;
  error_table(title, model, grid, measure, rows_of(model, grid, {.tolerance = 1e-13}, measure, report));
}

void four_bar_table(const char* title, int n, double until) {
  const TimeGrid grid = TimeGrid::range(0, until, 0.5);
  Parallelogram parallelogram(n);
  std::vector<double> exact;
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    const Vec2<double> end = parallelogram.crank_end(grid[k]);
    exact.insert(exact.end(), {end.x, end.y});
  }
  error_table(title, four_bars(n), grid, first_crank_end, exact);
}

}  // namespace

void print_acceleration_costs() {
  fmt::print("\nAccelerations of a chain of rods (trigonometry, Jacobian, factors, solve), ns a body.\n{:>8} {:>10}\n",
             "bodies", "ns");
  for (int n : {100, 1000, 10000, 100000, 1000000}) {
    const auto model = chain(n);
    EvaluationWork work;
    Evaluator evaluator(Plan::make(*model), *model, work);
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
  const auto at = [](double t) { return TimeGrid::instant(t); };
  error_table("A chain of 40 rods of 1 m falls for 1 s, worst place of any rod's middle, m:", straight_chain(40), at(1),
              places);
  four_bar_table("Two four-bars for 20 s, through the flat position some twenty times, end of a crank, m:", 2, 20);
  four_bar_table("Forty four-bars for 10 s, through the flat position some ten times, end of a crank, m:", 40, 10);
  error_table("Andrews' squeezing mechanism to 0.03 s, worst angle, rad:", squeezer(), at(0.03), angles);
  error_table("A double pendulum of rods for 2 s, worst angle, rad:", straight_chain(2), at(2), angles);
  error_table("The car axis of the Test Set to 3 s, worst place, m:", car_axis(), at(3), places);
}

}  // namespace bench
