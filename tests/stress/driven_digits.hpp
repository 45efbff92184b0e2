// Digits of driven random mechanisms: what inverse_dynamics claims beside the same equations solved densely in long
// double (dense_mechanism.hpp) at the instants of its rows.
#pragma once

#include "oracles/claimed_digits.hpp"
#include "references/dense.hpp"
#include "stress/random_scene.hpp"

namespace catena::testing {

struct ExactState {
  Vector q, v, a, loads;  ///< loads: of the rows that were kept
};

/// Newton's method from q on the rows kept; empty where it does not converge to long double's rounding.
inline ExactState exact_state(const DenseMechanism& dense, const std::vector<Eigen::Index>& kept, Real t, Vector q) {
  const Vector zero = Vector::Zero(dense.size());
  const auto count = static_cast<Eigen::Index>(kept.size());
  const auto of_kept = [&](auto&& value) {
    Vector rows(count);
    for (Eigen::Index k = 0; k < count; ++k)
      rows[k] = value(static_cast<std::size_t>(kept[static_cast<std::size_t>(k)]));
    return rows;
  };
  const auto matrix = [&] {
    const Matrix all = dense.jacobian(t, q);
    Matrix rows(count, dense.size());
    for (Eigen::Index k = 0; k < count; ++k) rows.row(k) = all.row(kept[static_cast<std::size_t>(k)]);
    return rows;
  };
  // Angles of gears are continuous in the scene, and those of centres are not here.
  for (const Eigen::Index k : kept) {
    if (std::abs(dense.residuals(t, q, zero, zero)[static_cast<std::size_t>(k)].f) > 1e-6L * dense.length) return {};
  }
  Real last = 1e300L;
  for (int k = 0; k < 6; ++k) {
    const std::vector<Jet> phi = dense.residuals(t, q, zero, zero);
    const Vector step = solve<Real>(matrix(), of_kept([&](std::size_t r) { return phi[r].f; }));
    q -= step;
    last = step.cwiseAbs().maxCoeff();
  }
  ExactState state;
  if (!(last < 1e-15L * std::max(Real(1), q.cwiseAbs().maxCoeff()))) return state;
  const ReferenceFactors<Real> lu(matrix());
  const std::vector<Jet> at_rest = dense.residuals(t, q, zero, zero);
  state.v = lu.solve(of_kept([&](std::size_t r) { return -at_rest[r].d; }));
  const std::vector<Jet> moving = dense.residuals(t, q, state.v, zero);
  state.a = lu.solve(of_kept([&](std::size_t r) { return -moving[r].dd; }));
  const Vector inertia = dense.masses().cwiseProduct(state.a) - dense.forces(t, q, state.v);
  state.loads = solve<Real>(matrix().transpose(), inertia);
  state.q = q;
  return state;
}

/// Adds the columns of one mechanism; how it went, in words.
inline std::string add_driven_digits(unsigned seed, ClaimedDigits& claims) {
  RandomScene random(seed, RandomScene::Forces::moving);
  DenseMechanism& dense = random.dense;
  // Some rows have the value of the start, which the scene takes from the given configuration; others are zero there
  // but for the rounding of their places.
  const Vector zero = Vector::Zero(dense.size());
  const std::vector<Jet> start = dense.residuals(0, random.q, zero, zero);
  for (std::size_t k = 0; k < dense.rows.size(); ++k) {
    const Real constant = std::abs(start[k].f) > 1e-10L * Real(random.size) ? start[k].f : 0;
    dense.rows[k].phi = [phi = dense.rows[k].phi, constant](const JetPlace& i, const JetPlace& j, Jet t) {
      return phi(i, j, t) - Jet{constant};
    };
  }
  std::vector<std::size_t> driver_rows;
  for (int tries = 0; tries < 40; ++tries) {
    const std::size_t rank = dense.independent_rows(0, random.q).size();
    if (static_cast<Eigen::Index>(rank) == dense.size()) break;
    random.add_driver();
    driver_rows.push_back(dense.rows.size() - 1);
    if (dense.independent_rows(0, random.q).size() > rank) continue;
    dense.rows.pop_back();
    driver_rows.pop_back();
    random.scene["drivers"].erase(random.scene["drivers"].size() - 1);
  }
  if (static_cast<Eigen::Index>(dense.independent_rows(0, random.q).size()) != dense.size()) return "not driven";
  const double until = random.uniform(0.1, 1) / random.pace;
  random.scene["analyses"] = {{{"type", "inverse_dynamics"}, {"until", until}, {"every", until / 8}}};
  random.scene["outputs"] = {"energy.kinetic"};
  static const char* const columns[] = {".x", ".y", ".angle", ".vx", ".vy", ".omega", ".ax", ".ay", ".alpha"};
  for (std::size_t b = 0; b < dense.bodies.size(); ++b) {
    for (const char* column : columns) random.scene["outputs"].push_back("b" + std::to_string(b) + column);
  }
  for (std::size_t d = 0; d < driver_rows.size(); ++d) {
    random.scene["drivers"][d]["name"] = "d" + std::to_string(d);
    random.scene["outputs"].push_back("d" + std::to_string(d) + ".load");
  }
  const TextRun run = run_text(random.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  const AnalysisReport& report = run.analysis().report;
  if (!report.ok()) return std::string(to_string(report.status));
  if (run.analysis().digits.empty()) return "no claim";
  const std::vector<double> t = run.column("t");
  std::map<std::string, std::vector<long double>> exact;
  for (std::size_t row = 0; row < t.size(); ++row) {
    Vector q(dense.size());
    for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = run.column("b" + std::to_string(k / 3) + columns[k % 3])[row];
    // Of rows that depend on each other the best conditioned are others at every place.
    const std::vector<Eigen::Index> kept = dense.independent_rows(t[row], q);
    if (static_cast<Eigen::Index>(kept.size()) != dense.size()) return "not compared";
    const ExactState state = exact_state(dense, kept, t[row], q);
    if (state.q.size() == 0) return "not compared";
    Real energy = 0;
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const std::string body = "b" + std::to_string(k / 3);
      exact[body + columns[k % 3]].push_back(state.q[k]);
      exact[body + columns[3 + k % 3]].push_back(state.v[k]);
      exact[body + columns[6 + k % 3]].push_back(state.a[k]);
      energy += dense.masses()[k] * state.v[k] * state.v[k] / 2;
    }
    exact["energy.kinetic"].push_back(energy);
    for (std::size_t d = 0; d < driver_rows.size(); ++d) {
      const auto place = std::find(kept.begin(), kept.end(), static_cast<Eigen::Index>(driver_rows[d]));
      const std::string name = "d" + std::to_string(d) + ".load";
      // Those of rows that depend on others are not unique.
      if (kept.size() == dense.rows.size()) exact[name].push_back(state.loads[place - kept.begin()]);
    }
  }
  // What long double leaves beside the largest of the same order: rows that are zero are not told from it.
  const auto order = [](const std::string& column) {
    const std::string end = column.substr(column.find('.'));
    const auto place = std::find(std::begin(columns), std::end(columns), end) - std::begin(columns);
    return end == ".load" ? 4 : place / 3;
  };
  const double speed = random.size * random.pace, natural[] = {random.size, speed, speed * random.pace, 0, 0};
  std::map<std::ptrdiff_t, Real> largest;
  for (std::ptrdiff_t k = 0; k < 5; ++k) largest[k] = 10 * natural[k];
  for (const auto& [column, values] : exact) {
    for (const Real value : values) largest[order(column)] = std::max(largest[order(column)], std::abs(value));
  }
  for (const auto& [column, values] : exact)
    claims.add(run, column, values, "seed " + std::to_string(seed), 0, {}, 1e-17L * largest[order(column)]);
  return "compared";
}

}  // namespace catena::testing
