// Digits of random mechanisms in motion: what dynamics claims with an estimate of its error beside a dense formulation
// integrated by extrapolation in long double (dense_mechanism.hpp).
#pragma once

#include "oracles/claimed_digits.hpp"
#include "stress/random_scene.hpp"

namespace catena::testing {

/// Adds the columns of one mechanism; how it went, in words.
inline std::string add_moving_digits(unsigned seed, ClaimedDigits& claims) {
  RandomScene random(seed, RandomScene::Forces::moving);
  random.set_moving();
  const DenseMechanism& dense = random.dense;
  const Eigen::Index n = dense.size();
  const double until = random.uniform(0.3, 2) / random.pace, tolerance = std::pow(10.0, -random.pick(5) - 5);
  random.scene["analyses"] = {{{"type", "dynamics"},
                               {"until", until},
                               {"every", until / 4},
                               {"tolerance", tolerance},
                               {"estimate_error", true},
                               {"max_steps", 100000}}};
  random.scene["outputs"] = Json::array();
  static const char* const columns[] = {".x", ".y", ".angle", ".vx", ".vy", ".omega"};
  for (std::size_t b = 0; b < dense.bodies.size(); ++b) {
    for (const char* column : columns) random.scene["outputs"].push_back("b" + std::to_string(b) + column);
  }
  const TextRun run = run_text(random.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  if (!run.analysis().report.ok()) return std::string(to_string(run.analysis().report.status));
  if (run.analysis().digits.empty()) return "no claim";
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
    for (Eigen::Index k = 0; k < n; ++k) {
      const std::string body = "b" + std::to_string(k / 3);
      exact[body + columns[k % 3]].push_back(motion.y()[k]);
      exact[body + columns[3 + k % 3]].push_back(motion.y()[n + k]);
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
    const bool rate = column.find(".v") != std::string::npos || column.find(".omega") != std::string::npos;
    const double noise = 1e-14 * random.size * (rate ? random.pace : 1);
    claims.add(run, column, values, "seed " + std::to_string(seed), 0, {}, noise);
  }
  return "compared";
}

}  // namespace catena::testing
