#include "cases/contact_gradients.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "catena/results/stored_results.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "timing.hpp"

namespace bench {

using namespace catena;

namespace {

constexpr double field = 9.81;  // of gravity, m/s^2

/// A motion with contacts: its scene up to the analysis, the analysis, what it is differentiated by, and how fast its
/// measure changes with that.
struct ContactCase {
  std::string problem, scene, analysis, parameters;
  std::vector<double> exact;
};

// Dropped from h: with c = h - r the first fall takes t1 = sqrt(2 c / g), and bounce n comes at T = t1 (1 + 2 sum of
// e^k, k < n). At t between bounces n and n + 1:  y = r + e^n g t1 (t - T) - g (t - T)^2 / 2.
ContactCase bouncing_ball() {
  constexpr double h = 1, e = 0.6, r = 0.05, t = 1.6;
  const double t1 = std::sqrt(2 * (h - r) / field), v1 = field * t1;
  int n = 0;
  double sum = 1, by_e = 0, power = 1;  // of T / t1; e^n
  for (double next = 1; next * t1 < t; ++n) {
    sum = next;
    if (n > 0) by_e += 2 * n * power / e;
    power *= e;
    next += 2 * power;
  }
  const double s = t - sum * t1, time_by_c = sum / (field * t1), time_by_e = by_e * t1;
  const double by_c = power * (s / t1 - v1 * time_by_c) + field * s * time_by_c;
  const double y_by_e = n * power / e * v1 * s - power * v1 * time_by_e + field * s * time_by_e;
  return {"ball that bounces",
          fmt::format(R"json({{"catena": 1, "gravity": [0, -{}], "parameters": {{"h": {}, "e": {}, "r": {}}},
 "bodies": {{"ball": {{"particle": true, "mass": 2, "position": [0, "h"]}}}},
 "forces": [{{"type": "contact", "name": "floor", "i": "ground", "j": "ball", "radius": "r", "restitution": "e",
  "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}],
 "outputs": ["ball.y"], "analyses": [)json",
                      field, h, e, r),
          fmt::format(R"json({{"type": "dynamics", "until": {}, "every": 0.1, "tolerance": 1e-9,
  "measures": {{"end": {{"final": "ball.y"}}}}}})json",
                      t),
          R"json(["h", "e", "r"])json",
          {by_c, y_by_e, 1 - by_c}};
}

// Pushed along a floor:  x = v t - mu g t^2 / 2  as long as it slides.
ContactCase sliding_block() {
  constexpr double v = 3, mu = 0.2, t = 1;
  return {"block that slides",
          fmt::format(R"json({{"catena": 1, "gravity": [0, -{}], "parameters": {{"v": {}, "mu": {}, "m": 2}},
 "bodies": {{"block": {{"particle": true, "mass": "m", "position": [0, 0.05], "velocity": ["v", 0]}}}},
 "forces": [{{"type": "contact", "name": "floor", "i": "ground", "j": "block", "radius": 0.05, "mu": "mu",
  "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}],
 "outputs": ["block.x"], "analyses": [)json",
                      field, v, mu),
          fmt::format(R"json({{"type": "dynamics", "until": {}, "every": 0.1, "tolerance": 1e-9,
  "measures": {{"end": {{"final": "block.x"}}}}}})json",
                      t),
          R"json(["v", "mu", "m"])json",
          {t, -field * t * t / 2, 0}};
}

std::vector<double> gradient_of(const SceneOutcome& outcome) {
  std::vector<double> all;
  if (outcome.exit_code != 0 || outcome.analyses.empty()) return all;
  for (const MeasureResult& measure : outcome.analyses.front().measures)
    all.insert(all.end(), measure.gradient.begin(), measure.gradient.end());
  return all;
}

double largest_error(const std::vector<double>& found, const std::vector<double>& exact) {
  if (found.size() != exact.size()) return not_measured;
  double worst = 0, largest = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const double off = std::abs(found[k] - exact[k]);
    if (!(off <= worst)) worst = off;
    largest = std::max(largest, std::abs(exact[k]));
  }
  return worst / largest;
}

void measure_gradients(Bench& bench, const ContactCase& of) {
  Row row{.suite = "design", .problem = "gradient of a " + of.problem, .bodies = 1};
  row.setting = tolerance_text(1e-9);
  row.method = "adjoint";
  if (!bench.wants(row)) return;
  SceneOutcome outcome;
  const auto run = [&](const std::string& analysis) {
    RunOptions options;
    options.text = of.scene + analysis + "]}";
    options.digits = false;  // gradients are compared with one run, without the second one that tells digits
    StoredResults rows;
    outcome = run_scene("design", options, rows);
  };
  bench.time(row, [&] { run(of.analysis); });
  const double motion = row.seconds;
  row.error_of = "derivatives, relative";
  row.reference = "closed form";
  row.allowed = 1e-8;  // ten times the tolerance
  for (const char* mode : {"adjoint", "forward"}) {
    const std::string sensitivity =
        fmt::format(R"json({{"type": "sensitivity", "parameters": {}, "mode": "{}", "of": )json", of.parameters, mode);
    row.method = mode;
    bench.time(row, [&] { run(sensitivity + of.analysis + "}"); });
    const std::vector<double> found = gradient_of(outcome);
    row.error = largest_error(found, of.exact);
    row.failure = found.empty() ? "no gradient: " + outcome.error_text : "";
    row.counts = {{"parameters", static_cast<double>(of.exact.size())},
                  {"run, us", 1e6 * motion},
                  {"runs", row.seconds / motion}};
    bench.add(row);
  }
}

}  // namespace

void contact_gradients(Bench& bench) {
  measure_gradients(bench, bouncing_ball());
  measure_gradients(bench, sliding_block());
}

}  // namespace bench
