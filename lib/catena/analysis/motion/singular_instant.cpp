#include "catena/analysis/motion/singular_instant.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/analysis/pose/singular_point.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Equations of the completed system that are this near to dependence are dropped.
constexpr double says_nothing = 1e-6;
// Displacement over which derivatives are taken, rad or length scales.
constexpr double small_move = 1e-5;
constexpr double noticeable = 1e-6;

/// Phi_q (all slots) and gamma at an instant, and their derivatives along the straight line of the motion.
struct JacobianAlong {
  std::vector<double> values, rate, gamma, gamma_rate;
};

/// By central differences over the time `e`. Leaves the evaluator at t and q.
JacobianAlong differentiate_along(Evaluator& evaluator, double t, std::span<const double> q, std::span<const double> qd,
                                  double e) {
  const Plan& plan = evaluator.plan();
  JacobianAlong along;
  along.values.resize(at(plan.trash_slot()) + 1);
  along.gamma.resize(at(plan.rows));
  std::vector<double> moved(q.begin(), q.end());
  evaluator.start_jacobian(along.values);
  const auto evaluate = [&](double steps) {
    for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = q[k] + steps * e * qd[k];
    evaluator.set_time_along(t + steps * e, t);
    evaluator.set_configuration(moved);
    evaluator.jacobian(along.values);
    evaluator.gamma(qd, along.gamma);
  };
  evaluate(1);
  along.rate = along.values;
  along.gamma_rate = along.gamma;
  evaluate(-1);
  for (std::size_t k = 0; k < along.rate.size(); ++k) along.rate[k] = (along.rate[k] - along.values[k]) / (2 * e);
  for (std::size_t k = 0; k < along.gamma.size(); ++k)
    along.gamma_rate[k] = (along.gamma_rate[k] - along.gamma[k]) / (2 * e);
  evaluate(0);
  return along;
}

/// The independent equations and those that their dependences make, by columns.
struct CompletedSystem {
  int independent = 0, extra = 0;
  Eigen::MatrixXd rows, terms_of_rate;  ///< terms_of_rate: of the extra rows, without their signs
  Eigen::VectorXd right;
};

/// The right-hand sides; `null`: the weights of the equations in every dependence. False: w^T gamma does not vanish.
bool find_right_hand_sides(const RankReport& rank, const JacobianAlong& along, CompletedSystem& system,
                           std::vector<std::vector<double>>& null) {
  for (int k = 0; k < system.independent; ++k) system.right[k] = along.gamma[at(rank.independent_rows[at(k)])];
  for (int k = 0; k < system.extra; ++k) {
    double sum = 0, terms = 0, rate = 0;
    for (int n = rank.left_null_vectors.start[at(k)]; n < rank.left_null_vectors.start[at(k) + 1]; ++n) {
      const auto row = at(rank.left_null_vectors.index[at(n)]);
      const double weight = rank.left_null_vectors.value[at(n)];
      null[at(k)][row] = weight;
      sum += weight * along.gamma[row];
      terms += std::abs(weight * along.gamma[row]);
      rate += weight * along.gamma_rate[row];
    }
    if (std::abs(sum) > vanishing_part * terms) return false;
    system.right[system.independent + k] = rate / 3;
  }
  return true;
}

/// Nothing where w^T gamma does not vanish.
std::optional<CompletedSystem> complete(const Plan& plan, const RankReport& rank, const JacobianAlong& along) {
  CompletedSystem system;
  system.independent = rank.rank;
  system.extra = static_cast<int>(rank.dependent_rows.size());
  system.rows = Eigen::MatrixXd::Zero(system.independent + system.extra, plan.columns);
  system.terms_of_rate = Eigen::MatrixXd::Zero(system.extra, plan.columns);
  system.right.resize(system.rows.rows());
  std::vector<std::vector<double>> null(at(system.extra), std::vector<double>(at(plan.rows), 0.0));
  if (!find_right_hand_sides(rank, along, system, null)) return {};
  std::vector<int> place(at(plan.rows), -1);
  for (int k = 0; k < rank.rank; ++k) place[at(rank.independent_rows[at(k)])] = k;
  for (int c = 0; c < plan.columns; ++c) {
    for (int n = plan.jacobian.column_start[at(c)]; n < plan.jacobian.column_start[at(c) + 1]; ++n) {
      const auto row = at(plan.jacobian.row_index[at(n)]);
      if (place[row] >= 0) system.rows(place[row], c) = along.values[at(n)];
      for (int k = 0; k < system.extra; ++k) {
        system.rows(rank.rank + k, c) += null[at(k)][row] * along.rate[at(n)];
        system.terms_of_rate(k, c) += std::abs(null[at(k)][row] * along.rate[at(n)]);
      }
    }
  }
  return system;
}

/// In the metric of the masses (`root`: their square roots by columns), rows of length one.
void normalise_rows(CompletedSystem& system, const Eigen::VectorXd& root) {
  system.rows = system.rows * root.cwiseInverse().asDiagonal();
  system.terms_of_rate = system.terms_of_rate * root.cwiseInverse().asDiagonal();
  for (int r = 0; r < system.rows.rows(); ++r) {
    const double length = system.rows.row(r).norm();
    // For a lasting dependence the terms cancel up to the error of the differences.
    const double terms = r < system.independent ? length : system.terms_of_rate.row(r - system.independent).norm();
    if (!(length > says_nothing * terms)) {
      system.rows.row(r).setZero();
      system.right[r] = 0;
      continue;
    }
    system.rows.row(r) /= length;
    system.right[r] /= length;
  }
}

Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decompose(const Eigen::MatrixXd& matrix) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(says_nothing);
  decomposition.compute(matrix);
  return decomposition;
}

}  // namespace

SingularInstant::Outcome SingularInstant::solve(double t, std::span<const double> q, std::span<const double> qd,
                                                std::span<double> qdd) {
  Evaluator& evaluator = equations_.evaluator();
  const Plan& plan = equations_.plan();
  const MassMatrix& masses = equations_.masses();
  if (plan.rows == 0 || plan.rows > most_rows || !masses.massless.empty()) return Outcome::not_found;
  double speed = 0;
  for (int k = 0; k < 3 * plan.moving; ++k) {
    speed = std::max(speed, std::abs(qd[at(k)]) / (k % 3 == 2 ? 1 : evaluator.length_scale()));
  }
  loads_.assign(equations_.applied_forces().begin(), equations_.applied_forces().end());
  moment_ = speed > 0 ? small_move / speed : small_move;
  const JacobianAlong along = differentiate_along(evaluator, t, q, qd, moment_);

  RankOptions options;
  options.tolerance = dependence::follows_nearby;
  options.most_null_vectors = 0;
  const RankReport rank = jacobian_rank(evaluator, plan.jacobian,
                                        std::span<const double>(along.values).first(at(plan.trash_slot())), options);
  const int extra = static_cast<int>(rank.dependent_rows.size());
  if (!rank.ok() || extra == 0 || rank.left_null_vectors.count() != extra) return Outcome::not_found;
  std::optional<CompletedSystem> system = complete(plan, rank, along);
  if (!system) return Outcome::not_found;

  Eigen::VectorXd root(plan.columns), free(plan.columns);
  for (int c = 0; c < plan.columns; ++c) {
    const auto coordinate = at(plan.coordinate[at(c)]);
    root[c] = std::sqrt(masses.mass[coordinate]);
    free[c] = loads_[coordinate] / root[c];
  }
  normalise_rows(*system, root);
  // y = sqrt(M) (qdd - M^-1 Q), the least one that the rows allow.
  const auto decomposed = decompose(system->rows);
  if (decomposed.rank() == rank.rank) return Outcome::always_dependent;
  const Eigen::VectorXd y = decomposed.solve(system->right - system->rows * free);
  const Eigen::VectorXd multipliers = decompose(system->rows.transpose()).solve(-y);
  const Eigen::VectorXd carried = system->rows.bottomRows(extra).transpose() * multipliers.tail(extra);
  unbounded_ = carried.norm() > noticeable * (free.norm() + y.norm());
  std::fill(qdd.begin(), qdd.end(), 0.0);
  for (int c = 0; c < plan.columns; ++c) {
    const auto coordinate = at(plan.coordinate[at(c)]);
    qdd[coordinate] = (y[c] + free[c]) / root[c];
    loads_[coordinate] -= root[c] * (y[c] + free[c] + carried[c]);
  }
  return Outcome::found;
}

}  // namespace catena
