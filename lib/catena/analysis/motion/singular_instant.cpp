#include "catena/analysis/motion/singular_instant.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Equations this near to dependence (sine) count as dependent; the resulting error of accelerations is of the same
// size.
constexpr double dependent = 3e-4;
// Part of the terms of w^T gamma above which the sum does not vanish.
constexpr double vanishing = 1e-2;
// Equations of the completed system that are this near to dependence are dropped.
constexpr double says_nothing = 1e-6;
// Displacement over which derivatives are taken, rad or length scales.
constexpr double small_move = 1e-5;
constexpr double noticeable = 1e-6;

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
  std::vector<double> moved(q.begin(), q.end()), values(at(plan.trash_slot()) + 1), gamma(at(plan.rows));
  evaluator.start_jacobian(values);
  const double e = moment_ = speed > 0 ? small_move / speed : small_move;
  const auto evaluate = [&](double steps) {
    for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = q[k] + steps * e * qd[k];
    evaluator.set_time_along(t + steps * e, t);
    evaluator.set_configuration(moved);
    evaluator.jacobian(values);
    evaluator.gamma(qd, gamma);
  };
  evaluate(1);
  std::vector<double> jacobian_rate = values, gamma_rate = gamma;
  evaluate(-1);
  for (std::size_t k = 0; k < values.size(); ++k) jacobian_rate[k] = (jacobian_rate[k] - values[k]) / (2 * e);
  for (std::size_t k = 0; k < gamma.size(); ++k) gamma_rate[k] = (gamma_rate[k] - gamma[k]) / (2 * e);
  evaluate(0);

  RankOptions options;
  options.tolerance = dependent;
  options.most_null_vectors = 0;
  const RankReport rank =
      jacobian_rank(evaluator, plan.jacobian, std::span<const double>(values).first(at(plan.trash_slot())), options);
  const int extra = static_cast<int>(rank.dependent_rows.size());
  if (!rank.ok() || extra == 0 || rank.left_null_vectors.count() != extra) return Outcome::not_found;

  // Equations of the completed system: the weight of each equation of the plan in them.
  const int size = rank.rank + extra;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(size, plan.columns);
  Eigen::MatrixXd terms_of_rate = Eigen::MatrixXd::Zero(extra, plan.columns);
  Eigen::VectorXd right(size);
  std::vector<int> place(at(plan.rows), -1);
  for (int k = 0; k < rank.rank; ++k) {
    place[at(rank.independent_rows[at(k)])] = k;
    right[k] = gamma[at(rank.independent_rows[at(k)])];
  }
  std::vector<std::vector<double>> null(at(extra), std::vector<double>(at(plan.rows), 0.0));
  for (int k = 0; k < extra; ++k) {
    double sum = 0, terms = 0, rate = 0;
    for (int n = rank.left_null_vectors.start[at(k)]; n < rank.left_null_vectors.start[at(k) + 1]; ++n) {
      const auto row = at(rank.left_null_vectors.index[at(n)]);
      const double weight = rank.left_null_vectors.value[at(n)];
      null[at(k)][row] = weight;
      sum += weight * gamma[row];
      terms += std::abs(weight * gamma[row]);
      rate += weight * gamma_rate[row];
    }
    if (std::abs(sum) > vanishing * terms) return Outcome::not_found;
    right[rank.rank + k] = rate / 3;
  }
  Eigen::VectorXd root(plan.columns), free(plan.columns);
  for (int c = 0; c < plan.columns; ++c) {
    const auto coordinate = at(plan.coordinate[at(c)]);
    root[c] = std::sqrt(masses.mass[coordinate]);
    free[c] = loads_[coordinate] / root[c];
    for (int n = plan.jacobian.column_start[at(c)]; n < plan.jacobian.column_start[at(c) + 1]; ++n) {
      const auto row = at(plan.jacobian.row_index[at(n)]);
      if (place[row] >= 0) rows(place[row], c) = values[at(n)];
      for (int k = 0; k < extra; ++k) {
        rows(rank.rank + k, c) += null[at(k)][row] * jacobian_rate[at(n)];
        terms_of_rate(k, c) += std::abs(null[at(k)][row] * jacobian_rate[at(n)]);
      }
    }
  }
  // In the metric of the masses, rows of length one: y = sqrt(M) (qdd - M^-1 Q), the least one that they allow.
  rows = rows * root.cwiseInverse().asDiagonal();
  terms_of_rate = terms_of_rate * root.cwiseInverse().asDiagonal();
  for (int r = 0; r < size; ++r) {
    const double length = rows.row(r).norm();
    // For a lasting dependence the terms cancel up to the error of the differences.
    const double terms = r < rank.rank ? length : terms_of_rate.row(r - rank.rank).norm();
    if (!(length > says_nothing * terms)) {
      rows.row(r).setZero();
      right[r] = 0;
      continue;
    }
    rows.row(r) /= length;
    right[r] /= length;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> system;
  system.setThreshold(says_nothing);
  system.compute(rows);
  if (system.rank() == rank.rank) return Outcome::always_dependent;
  const Eigen::VectorXd y = system.solve(right - rows * free);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> transposed;
  transposed.setThreshold(says_nothing);
  transposed.compute(rows.transpose());
  const Eigen::VectorXd multipliers = transposed.solve(-y);
  const Eigen::VectorXd carried = rows.bottomRows(extra).transpose() * multipliers.tail(extra);
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
