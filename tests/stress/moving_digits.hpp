// Digits of random mechanisms in motion: what dynamics claims, of one run or with an estimate of its error from two,
// beside a dense formulation integrated by extrapolation in long double (dense_mechanism.hpp).
#pragma once

#include "oracles/claimed_digits.hpp"
#include "stress/cases.hpp"
#include "stress/random_scene.hpp"

namespace catena::testing {

/// How digits are found: of one run, of two with an estimate of the error, or by a second run of these methods.
enum class Runs { one, two, adams, baumgarte, partitioning };

/// Adds the columns of one mechanism; how it went, in words. Fixed steps vary as well, except with `two`; with `one`
/// the method too.
inline std::string add_moving_digits(unsigned seed, ClaimedDigits& claims, Runs runs = Runs::two) {
  RandomScene random(seed, RandomScene::Forces::moving);
  random.set_moving();
  const DenseMechanism& dense = random.dense;
  const Eigen::Index n = dense.size();
  const double until = random.uniform(0.3, 2) / random.pace;
  Json analysis = {{"type", "dynamics"}, {"until", until}, {"every", until / 4}, {"max_steps", 100000}};
  if (runs == Runs::two) {
    analysis["tolerance"] = std::pow(10.0, -random.pick(5) - 5);
    analysis["estimate_error"] = true;
  } else {
    static const char* const told[] = {"auto", "auto", "auto", "rk8", "rk8", "rk5"};
    const int method = random.pick(6);
    analysis["method"] = runs == Runs::adams          ? "adams"
                         : runs == Runs::baumgarte    ? "baumgarte"
                         : runs == Runs::partitioning ? "partitioning"
                                                      : told[method];
    const double tolerance = std::pow(10.0, -random.pick(7) - 4), step = random.uniform(0.01, 0.1) / random.pace;
    if (random.pick(6)) {
      analysis["tolerance"] = tolerance;
    } else {
      analysis["step"] = step;
    }
  }
  // Events that only look, here and there: their rows are compared at the instants that they have.
  const bool looks = runs == Runs::one && random.pick(4) == 0;
  if (looks) analysis["events"] = Json::array({{{"name", "turns back"}, {"when", "b0.vx"}}});
  random.scene["analyses"] = Json::array({analysis});
  random.scene["outputs"] = Json::array();
  static const char* const columns[] = {".x", ".y", ".angle", ".vx", ".vy", ".omega", ".ax", ".ay", ".alpha"};
  for (std::size_t b = 0; b < dense.bodies.size(); ++b) {
    // Of two runs accelerations may have the same rounding.
    for (const char* column : std::span(columns).first(runs != Runs::two ? 9 : 6))
      random.scene["outputs"].push_back("b" + std::to_string(b) + column);
  }
  static const char* const kinds[] = {"moving", "moving_twice", "moving_adams", "moving_baumgarte",
                                      "moving_partitioning"};
  keep_scene(kinds[static_cast<std::size_t>(runs)], seed, random.scene.dump(1));
  const TextRun run = run_text(random.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  if (!run.analysis().report.ok()) return std::string(to_string(run.analysis().report.status));
  if (run.analysis().digits.empty()) return "no claim";
  std::string what = "seed " + std::to_string(seed);
  if (runs != Runs::two) what += analysis.contains("step") ? " fixed " : " " + analysis["tolerance"].dump() + " ";
  if (runs != Runs::two) what += analysis["method"].get<std::string>();
  const auto kept = dense.independent_rows(0, random.q);
  const auto slope = [&](Real t, const Vector& y) {
    Vector rate(2 * n);
    rate << y.tail(n), acceleration(dense, kept, t, y.head(n), y.tail(n));
    return rate;
  };
  Vector y(2 * n), scale(2 * n);
  y << random.q, random.v;
  for (Eigen::Index k = 0; k < n; ++k) {
    scale[k] = k % 3 == 2 ? 1 : Real(random.size);
    scale[n + k] = scale[k] * Real(random.pace);
  }
  Extrapolation motion(slope, y, scale, 0.02L / random.pace, 1e-15L);
  std::map<std::string, std::vector<long double>> exact;
  for (const double t : run.column("t")) {
    if (!motion.go_to(t, 400)) return "not compared";
    Vector a;
    if (runs != Runs::two) a = acceleration(dense, kept, t, motion.y().head(n), motion.y().tail(n));
    for (Eigen::Index k = 0; k < n; ++k) {
      const std::string body = "b" + std::to_string(k / 3);
      exact[body + columns[k % 3]].push_back(motion.y()[k]);
      exact[body + columns[3 + k % 3]].push_back(motion.y()[n + k]);
      if (runs != Runs::two) exact[body + columns[6 + k % 3]].push_back(a[k]);
    }
  }
  // Redundant rows that stay met are no mistake of this formulation; others are.
  const Vector zero = Vector::Zero(n), end = motion.y().head(n);
  const auto start = dense.residuals(0, random.q, zero, zero), now = dense.residuals(until, end, zero, zero);
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (std::abs(std::remainder((now[k].f - start[k].f) / Real(random.size), 2 * std::acos(Real(-1)))) > 1e-12L)
      return "not compared";
  }
  // The start of both is that of the scene to rounding only.
  for (const auto& [column, values] : exact) {
    const auto place = std::find(std::begin(columns), std::end(columns), column.substr(column.find('.')));
    const double noise = 1e-14 * random.size * std::pow(random.pace, (place - std::begin(columns)) / 3);
    claims.add(run, column, values, what, 0, {}, noise);
  }
  return "compared";
}

}  // namespace catena::testing
