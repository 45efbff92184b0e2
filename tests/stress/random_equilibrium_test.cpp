// Equilibria of random mechanisms of all joints and forces against the dense formulation (dense_mechanism.hpp): the
// energies of places nearby, and the reduced Hessian along sampled motions.
//
//   V' = 0 and V'' = z_i^T H z_j along q(s) = q + s z + s^2/2 a,   Phi_q z = 0,   Phi_q a = -Phi''(z, z)
//
// z: a basis of the motions that the joints allow; V'' of z_i, z_j by polarisation. An answer `ok` is a failure where
// joints are not met, forces not in balance, the energy is another one, the number of falling directions is another
// one, or a place nearby has less energy than one that is called stable.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "oracles/random_seeds.hpp"
#include "references/dense.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"
#include "stress/random_scene.hpp"

namespace catena::testing {
namespace {

/// The mechanism at a place of rest: scaled rows, and the motions that they allow.
class RestingPlace {
 public:
  RestingPlace(const RandomScene& random, Vector q) : dense_(random.dense), size_(random.size), q_(std::move(q)) {
    Matrix jacobian = dense_.jacobian(0, q_);
    for (Eigen::Index k = 2; k < jacobian.cols(); k += 3) jacobian.col(k) /= dense_.length;
    weights_ = Vector::Ones(jacobian.rows());
    for (Eigen::Index k = 0; k < jacobian.rows(); ++k) {
      weights_[k] = 1 / jacobian.row(k).norm();
      jacobian.row(k) *= weights_[k];
    }
    rows_ = LeastSquares<Real>(jacobian, 1e-7L);
    const Eigen::Index n = dense_.size();
    if (jacobian.rows() == 0) {
      basis_ = Matrix::Identity(n, n);
      return;
    }
    const DenseRows<Real> rows(jacobian, 1e-7L);
    rank_ = rows.rank();
    least_pivot_ = rows.least_pivot();
    basis_ = rows.null_space();
  }

  Eigen::Index freedoms() const { return basis_.cols(); }
  Eigen::Index rank() const { return rank_; }
  /// How far the rows that count are from being dependent.
  Real least_pivot() const { return least_pivot_; }

  Vector along(Eigen::Index k) const { return in_coordinates(basis_.col(k)); }
  /// V' and V'' along z, in units of size.
  Jet energy(const Vector& z) const {
    const Vector zero = Vector::Zero(dense_.size());
    Vector a = zero;
    if (rank_ > 0) {
      const std::vector<Jet> phi = dense_.residuals(0, q_, z, zero);
      Vector right(static_cast<Eigen::Index>(phi.size()));
      for (std::size_t k = 0; k < phi.size(); ++k)
        right[static_cast<Eigen::Index>(k)] = -phi[k].dd * weights_[static_cast<Eigen::Index>(k)];
      a = in_coordinates(rows_.solve(right));
    }
    return dense_.potential(q_, z, a);
  }
  Matrix hessian() const {
    const Eigen::Index n = freedoms();
    Matrix h(n, n);
    for (Eigen::Index i = 0; i < n; ++i) h(i, i) = energy(along(i)).dd;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) h(i, j) = h(j, i) = (energy(along(i) + along(j)).dd - h(i, i) - h(j, j)) / 2;
    }
    return h;
  }
  /// The place at q + s z, on the joints to rounding; empty where Newton's method does not find it.
  Vector moved(const Vector& z, Real s) const {
    const Vector zero = Vector::Zero(dense_.size());
    const std::vector<Jet> start = dense_.residuals(0, q_, zero, zero);
    Vector q = q_ + s * z;
    if (rank_ == 0) return q;
    for (int k = 0; k < 60; ++k) {
      const std::vector<Jet> phi = dense_.residuals(0, q, zero, zero);
      Vector right(static_cast<Eigen::Index>(phi.size()));
      for (std::size_t r = 0; r < phi.size(); ++r)
        right[static_cast<Eigen::Index>(r)] = (start[r].f - phi[r].f) * weights_[static_cast<Eigen::Index>(r)];
      const Vector change = in_coordinates(rows_.solve(right));
      q += change;
      if (change.cwiseAbs().maxCoeff() < 1e-16L * std::max(Real(1), Real(size_))) return q;
    }
    return {};
  }

 private:
  Vector in_coordinates(Vector z) const {
    for (Eigen::Index k = 2; k < z.size(); k += 3) z[k] /= dense_.length;
    return z;
  }

  const DenseMechanism& dense_;
  double size_;
  Vector q_, weights_;
  Matrix basis_;
  LeastSquares<Real> rows_{Matrix()};
  Eigen::Index rank_ = 0;
  Real least_pivot_ = 1;
};

/// The largest second derivatives that single loads and weights have: what rounding of a sum of them is measured by.
Real stiffness_of(const RandomScene& random, const Vector& q) {
  const DenseMechanism& dense = random.dense;
  const Vector zero = Vector::Zero(dense.size());
  Real most = 0;
  for (std::size_t b = 0; b < dense.bodies.size(); ++b)
    most += dense.bodies[b].mass * std::hypot(dense.gravity.x, dense.gravity.y) / dense.length;
  for (const auto& load : dense.loads) {
    const Jet s = dense.along(load, load.along, {}, q, zero, zero);
    const Vector g = dense.gradient(load, load.along, 0, q);
    Real slope = 0;
    for (Eigen::Index k = 0; k < g.size(); ++k)
      slope = std::max(slope, std::abs(g[k]) / (k % 3 == 2 ? dense.length : 1));
    const Real f = std::abs(load.force(s, 0, DenseMechanism::place(load.i, q, zero, zero)));
    most += std::abs(load.potential({s.f, 1, 0}).dd) * slope * slope + f * slope / dense.length;
  }
  return most;
}

std::string equilibrium_fault(unsigned seed, std::map<std::string, int>& seen) {
  RandomScene random(seed, RandomScene::Forces::still);
  const bool any = random.pick(3) == 0;
  random.scene["analyses"] = {{{"type", "equilibrium"}, {"accept", any ? "stationary" : "stable"}}};
  keep_scene("equilibrium", seed, random.scene.dump(1));
  const TextRun run = run_text(random.scene.dump());
  std::string which = any ? "(stationary)" : "";
  for (const std::string& type : random.types) which += " " + type;
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text + which;
  const AnalysisReport& report = run.analysis().report;
  ++seen[std::string(to_string(report.status))];
  if (!report.ok()) show_refusal(seed, report.message + " " + which);
  if (!report.ok()) return report.message.empty() ? "no message" + which : "";

  const DenseMechanism& dense = random.dense;
  Vector q(dense.size());
  for (std::size_t b = 0; b < dense.bodies.size(); ++b) {
    const std::string name = "b" + std::to_string(b);
    q.segment<3>(3 * static_cast<Eigen::Index>(b)) << run.last(name + ".x"), run.last(name + ".y"),
        run.last(name + ".angle");
  }
  const Real far = std::max(Real(1), q.cwiseAbs().maxCoeff() / Real(random.size));
  const Real missed = dense.missed(random.q, q);
  if (!(missed < 1e-11L * far)) return "joints are missed by " + std::to_string(double(missed)) + which;
  const RestingPlace place(random, q);
  const Vector zero = Vector::Zero(dense.size());
  const Real energy = dense.potential(q, zero, zero).f, given = field<double>(run, "energy");
  const Real stiffness = stiffness_of(random, q), unit = stiffness * dense.length * dense.length;
  if (!(std::abs(energy - given) <= 1e-11L * far * far * unit))
    return "the energy is " + std::to_string(double(energy)) + ", not " + std::to_string(double(given)) + which;
  if (place.least_pivot() < 1e-3L) return ++seen["(near a singular place)"], "";
  // Motions are known to rounding / pivot.
  const Real accuracy = 1e-9L * far / place.least_pivot();
  for (Eigen::Index k = 0; k < place.freedoms(); ++k) {
    const Real slope = place.energy(place.along(k)).d;
    if (!(std::abs(slope) <= accuracy * stiffness * dense.length))
      return "forces are not in balance: " + std::to_string(double(slope)) + " N along a motion, of " +
             std::to_string(double(stiffness * dense.length)) + which;
  }
  if (place.freedoms() == 0) return ++seen["(rigid)"], "";
  if (stiffness == 0) return ++seen["(no loads)"], "";
  const Vector curvature = symmetric_eigenvalues<Real>(place.hessian()) / stiffness;
  const auto count = [&](auto&& holds) {
    std::int64_t sum = 0;
    for (const Real c : curvature) sum += holds(c);
    return sum;
  };
  const Real zero_to = std::max(accuracy, Real(1e-6));
  const std::int64_t falling = count([&](Real c) { return c < -zero_to; }),
                     flat = count([&](Real c) { return std::abs(c) <= zero_to; });
  const std::int64_t negative = field<std::int64_t>(run, "negative_modes");
  const bool stable = field<bool>(run, "stable");
  if (negative < falling || negative > falling + flat)
    return "negative modes " + std::to_string(negative) + ", but " + std::to_string(falling) + " directions fall and " +
           std::to_string(flat) + " are flat" + which;
  if (stable && falling > 0) return "called stable, but energy falls" + which;
  if (!stable && falling == 0 && flat == 0) return "not called stable, but energy rises everywhere" + which;
  if (!stable) return ++seen[falling > 0 ? "(unstable)" : "(flat)"], "";
  for (int trial = 0; trial < 6; ++trial) {
    Vector z = zero;
    for (Eigen::Index k = 0; k < place.freedoms(); ++k) z += Real(random.uniform(-1, 1)) * place.along(k);
    const Vector nearby = place.moved(z, 1e-3L * random.size);
    if (nearby.size() == 0) continue;
    const Real gained = dense.potential(nearby, zero, zero).f - energy;
    if (!(gained >= -1e-13L * far * far * unit))
      return "called stable, but a place nearby has less energy by " + std::to_string(double(-gained)) + which;
  }
  return ++seen["(stable)"], "";
}

TEST(RandomEquilibrium, IsOneOfADenseFormulation) {
  std::map<std::string, int> seen;
  expect_no_fault(first_case(), last_case(2000), [&](unsigned seed) { return equilibrium_fault(seed, seen); });
  print_shares("equilibria of random mechanisms", seen);
}

}  // namespace
}  // namespace catena::testing
