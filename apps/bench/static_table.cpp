#include "static_table.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"
#include "catena/results/result_sink.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "timing.hpp"

namespace bench {

using namespace catena;

namespace {

constexpr double chain_length = 1.5, chain_mass = 1, gravity = 9.81, span = 1;

enum class Start { sagging, zigzag, above, straight, random };
constexpr Start all_starts[] = {Start::sagging, Start::zigzag, Start::above, Start::straight, Start::random};

const char* name_of(Start start) {
  switch (start) {
    case Start::sagging:
      return "sagging";
    case Start::zigzag:
      return "zigzag";
    case Start::above:
      return "above";
    case Start::straight:
      return "straight";
    default:
      return "random";
  }
}

/// n uniform rods between pins at (0, 0) and (span, 0).
std::shared_ptr<Model> hanging_chain(int n, Start start) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -gravity};
  const double l = chain_length / n, m = chain_mass / n;
  std::mt19937 generator(1);
  Vec2<double> end{};
  for (int k = 0; k < n; ++k) {
    const double t = (k + 0.5) / n;
    BodyValues body{.mass = m, .inertia = m * l * l / 12, .position = {span * t, 0}};
    if (start == Start::sagging) {
      body.position.y = -span * t * (1 - t);
      body.angle = 2.6 * (t - 0.5);
    } else if (start == Start::zigzag) {
      body.angle = (k % 2 ? -1 : 1) * std::acos(span / chain_length);
    } else if (start == Start::above) {
      body.position.y = span;
    } else if (start == Start::random) {
      body.angle = (static_cast<double>(generator()) / 4294967296.0 * 2 - 1) * std::numbers::pi;
      const Vec2<double> step = l * Vec2<double>{std::cos(body.angle), std::sin(body.angle)};
      body.position = end + 0.5 * step;
      end += step;
    }
    model->add_body("link" + std::to_string(k), body);
    model->add("", Revolute<>{{k == 0 ? 0 : l / 2, 0}, {-l / 2, 0}}, k == 0 ? ground : k - 1, k);
  }
  model->add("", Revolute<>{{span, 0}, {l / 2, 0}}, ground, n - 1);
  return model;
}

/// The tangent of a link's angle is its share of the weight over the horizontal force, which a bisection finds.
double exact_tension(int n) {
  long double low = 1e-6L, high = 1e6L;
  for (int k = 0; k < 100; ++k) {
    const long double force = std::sqrt(low * high);
    long double reach = 0;
    for (int i = 0; i < n; ++i) {
      const long double weight = static_cast<long double>(gravity) * chain_mass / n * (i - (n - 1) / 2.0L);
      reach += static_cast<long double>(chain_length) / n * force / std::sqrt(force * force + weight * weight);
    }
    (reach < span ? low : high) = force;
  }
  return static_cast<double>(low);
}

double error_of(const Equilibrium& chain, double tension) { return std::abs(chain.lambda()[0] / tension - 1); }

void print_starts() {
  fmt::print(
      "\nEquilibrium of a hanging chain by Newton. ns: a body an iteration, structure known, certificate included.\n"
      "{:>8} {:>9} {:>10} {:>8} {:>8} {:>12}\n",
      "links", "start", "iterations", "factors", "ns", "error of H");
  for (const int n : {1000, 10000, 100000, 1000000}) {
    const double tension = exact_tension(n);
    for (const Start start : all_starts) {
      // A million links take their time: two starts say enough.
      if (n > 300000 && start != Start::zigzag && start != Start::random) continue;
      Equilibrium chain(hanging_chain(n, start), {}, {.solver = StaticSolver::newton});
      const SystemState begin = chain.state();
      EquilibriumReport report = chain.solve();
      const std::int64_t factors = report.counters.factorizations;
      const double time = least_time(n > 300000 ? 1 : 3, 1, [&] {
        chain.start_from(begin);
        report = chain.solve();
      });
      fmt::print("{:8} {:>9} {:10} {:8} {:8.0f} {:12.1e}{}\n", n, name_of(start), report.iterations, factors,
                 1e9 * time / n / std::max(report.iterations, 1), error_of(chain, tension),
                 report.stable ? "" : "  " + report.message);
      std::fflush(stdout);
    }
  }
}

/// Bytes that the program held at most so far.
double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

std::string scene_text(int n) {
  return fmt::format(
      R"({{"catena": 1, "gravity": [0, -{1}], "parameters": {{"n": {0}, "l": "={2}/n", "m": "={3}/n"}},
 "replicate": [{{"count": {0}, "bodies": {{"link{{k}}": {{"mass": "m", "inertia": "=m*l*l/12",
   "position": ["=(k-0.5)/n", 0], "angle": "=acos(1/{2})*(-1)^k", "points": {{"from": ["=-l/2", 0], "to": ["=l/2", 0]}}}}}}}},
  {{"count": {4}, "first": 2, "constraints": [
   {{"type": "revolute", "name": "pin{{k}}", "i": "link{{k-1}}.to", "j": "link{{k}}.from"}}]}}],
 "constraints": [{{"type": "revolute", "name": "left", "i": "ground", "j": "link1.from"}},
  {{"type": "revolute", "name": "right", "i": ["ground", [1, 0]], "j": "link{0}.to"}}],
 "analyses": [{{"type": "equilibrium"}}], "outputs": ["left.fx"]}})",
      n, gravity, chain_length, chain_mass, n - 1);
}

/// Keeps the last value of the first column.
class LastValue final : public ResultSink, private RowSink {
 public:
  double value = 0;
  void begin_run(const RunHeader&) override {}
  RowSink& begin_analysis(std::string_view) override { return *this; }
  void end_analysis(const AnalysisResult&) override {}
  void end_run() override {}

 private:
  void begin(std::span<const ColumnInfo>) override {}
  bool row(std::span<const double> values) override {
    value = values.front();
    return true;
  }
};

/// Sizes ascend, since the peak is that of the program so far; before all other tables.
void print_totals() {
  fmt::print(
      "\nA scene of a chain laid out in zigzag: reading, plan, solution and certificate, a link.\n"
      "{:>8} {:>12} {:>8} {:>12}\n",
      "links", "microseconds", "bytes", "error of H");
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("catena_{}.json", std::random_device()());
  const double before = peak_bytes();
  for (const int n : {1000, 10000, 100000, 1000000}) {
    std::ofstream(file) << scene_text(n);
    LastValue tension;
    int exit_code = 0;
    const double time =
        least_time(n > 300000 ? 1 : 5, 1, [&] { exit_code = run_scene(file.string(), {}, tension).exit_code; });
    fmt::print("{:8} {:12.2f} {:8.0f} {:12.1e}{}\n", n, 1e6 * time / n, (peak_bytes() - before) / n,
               std::abs(-tension.value / exact_tension(n) - 1), exit_code == 0 ? "" : "  failed");
    std::fflush(stdout);
  }
  std::filesystem::remove(file);
}

void print_beside_ipopt() {
  fmt::print(
      "\nNewton beside Ipopt, both from the plan to the certificate.\n{:>8} {:>9} {:>7} {:>10} {:>10} {:>12} {:>12}\n",
      "links", "start", "solver", "iterations", "ms", "error of H", "residual, N");
  for (const int n : {1000, 10000}) {
    const double tension = exact_tension(n);
    for (const Start start : {Start::sagging, Start::zigzag}) {
      const auto model = hanging_chain(n, start);
      double times[2] = {0, 0};
      for (const StaticSolver solver : {StaticSolver::newton, StaticSolver::ipopt}) {
        const bool newton = solver == StaticSolver::newton;
        EquilibriumReport report;
        double error = 0;
        const double time = times[newton ? 0 : 1] = least_time(newton ? 5 : 1, 1, [&] {
          Equilibrium chain(model, {}, {.solver = solver});
          report = chain.solve();
          error = error_of(chain, tension);
        });
        fmt::print("{:8} {:>9} {:>7} {:10} {:10.2f} {:12.1e} {:12.1e}{}\n", n, name_of(start),
                   newton ? "newton" : "ipopt", report.iterations, 1e3 * time, error, report.residual,
                   report.ok() ? "" : "  " + report.message);
        std::fflush(stdout);
      }
      fmt::print("{:>27} {:.0f} times as long\n", "ipopt", times[1] / times[0]);
    }
  }
}

}  // namespace

void print_static_tables() {
  print_totals();
  print_starts();
  print_beside_ipopt();
}

}  // namespace bench
