// Digits of random mechanisms at rest: what equilibrium claims beside the balance of forces solved densely in long
// double (dense_mechanism.hpp) from the place that was found.
#pragma once

#include "oracles/claimed_digits.hpp"
#include "references/dense.hpp"
#include "stress/random_scene.hpp"

namespace catena::testing {

/// Q - Phi_q^T lambda and Phi of the rows kept.
inline Vector balance(const DenseMechanism& dense, const std::vector<Eigen::Index>& kept, const Vector& q,
                      const Vector& lambda) {
  const Vector zero = Vector::Zero(dense.size());
  const Matrix jacobian = dense.jacobian(0, q);
  const std::vector<Jet> phi = dense.residuals(0, q, zero, zero);
  Vector rest(dense.size() + lambda.size());
  rest.head(dense.size()) = dense.forces(0, q, zero);
  for (Eigen::Index k = 0; k < lambda.size(); ++k) {
    const Eigen::Index row = kept[static_cast<std::size_t>(k)];
    rest.head(dense.size()) -= lambda[k] * jacobian.row(row).transpose();
    rest[dense.size() + k] = phi[static_cast<std::size_t>(row)].f;
  }
  return rest;
}

/// Newton's method, whose matrix comes from differences; false where it does not converge.
inline bool settle(const DenseMechanism& dense, const std::vector<Eigen::Index>& kept, double size, Vector& q) {
  const Eigen::Index n = dense.size(), r = static_cast<Eigen::Index>(kept.size());
  Vector x(n + r);
  const Matrix jacobian = dense.jacobian(0, q);
  Matrix rows(r, n);
  for (Eigen::Index k = 0; k < r; ++k) rows.row(k) = jacobian.row(kept[static_cast<std::size_t>(k)]);
  x << q, LeastSquares<Real>(rows.transpose()).solve(dense.forces(0, q, Vector::Zero(n)));
  const auto rest = [&](const Vector& at) { return balance(dense, kept, at.head(n), at.tail(r)); };
  // Angles of gears are continuous in the scene, and those of centres are not here.
  if (r > 0 && rest(x).tail(r).cwiseAbs().maxCoeff() > 1e-6L * Real(size)) return false;
  Real last = 1e300L, before = 0;
  for (int iteration = 0; iteration < 8; ++iteration) {
    Matrix matrix(n + r, n + r);
    for (Eigen::Index k = 0; k < n + r; ++k) {
      const Real h = 1e-6L * (k >= n ? std::max(Real(1e-3L), std::abs(x[k])) : k % 3 == 2 ? 1 : Real(size));
      Vector ahead = x, behind = x;
      ahead[k] += h;
      behind[k] -= h;
      matrix.col(k) = (rest(ahead) - rest(behind)) / (2 * h);
    }
    Vector step = solve<Real>(matrix, rest(x));
    x -= step;
    before = last;
    last = 0;
    for (Eigen::Index k = 0; k < n; ++k) last = std::max(last, std::abs(step[k]) / (k % 3 == 2 ? 1 : Real(size)));
  }
  q = x.head(n);
  return last < 1e-15L && before < 1e-13L;
}

/// Adds the columns of one mechanism; how it went, in words.
inline std::string add_resting_digits(unsigned seed, ClaimedDigits& claims) {
  RandomScene random(seed, RandomScene::Forces::still);
  DenseMechanism& dense = random.dense;
  const Vector zero = Vector::Zero(dense.size());
  const std::vector<Jet> start = dense.residuals(0, random.q, zero, zero);
  for (std::size_t k = 0; k < dense.rows.size(); ++k) {
    const Real constant = std::abs(start[k].f) > 1e-10L * Real(random.size) ? start[k].f : 0;
    dense.rows[k].phi = [phi = dense.rows[k].phi, constant](const JetPlace& i, const JetPlace& j, Jet t) {
      return phi(i, j, t) - Jet{constant};
    };
  }
  random.scene["analyses"] = {{{"type", "equilibrium"}}};
  random.scene["outputs"] = Json::array();
  static const char* const columns[] = {".x", ".y", ".angle"};
  for (std::size_t b = 0; b < dense.bodies.size(); ++b) {
    for (const char* column : columns) random.scene["outputs"].push_back("b" + std::to_string(b) + column);
  }
  const TextRun run = run_text(random.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  if (!run.analysis().report.ok()) return std::string(to_string(run.analysis().report.status));
  if (run.analysis().digits.empty()) return "no claim";
  Vector q(dense.size());
  for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = run.first("b" + std::to_string(k / 3) + columns[k % 3]);
  const std::vector<Eigen::Index> kept = dense.independent_rows(0, q);
  if (!settle(dense, kept, random.size, q)) return "not compared";
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const std::string column = "b" + std::to_string(k / 3) + columns[k % 3];
    claims.add(run, column, {q[k]}, "seed " + std::to_string(seed));
  }
  return "compared";
}

}  // namespace catena::testing
