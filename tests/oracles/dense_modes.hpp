// Small oscillations by dense algebra, from the elements' second derivatives one by one: what the sparse search must
// find. K and M are projected on an orthonormal basis of the null space of Phi_q; multipliers by least squares. The
// algebra is in 80 bits, so that its rounding, relative to the largest of eigenvalues over many orders, does not count.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "references/dense.hpp"

namespace catena::testing {

/// All omega^2, ascending, about q (plan order) at the evaluator's time.
inline std::vector<double> dense_omega2(Evaluator& evaluator, std::span<const double> q) {
  using Wide = long double;
  using Matrix = Eigen::Matrix<Wide, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Wide, Eigen::Dynamic, 1>;
  const Plan& plan = evaluator.plan();
  const Eigen::Index n = plan.columns, m = plan.rows;
  const auto at = [](auto k) { return static_cast<std::size_t>(k); };
  evaluator.set_configuration(q);
  std::vector<double> values(at(plan.trash_slot()) + 1), rest(at(plan.coordinates()), 0.0), loads(rest.size());
  evaluator.start_jacobian(values);
  evaluator.jacobian(values);
  Matrix jacobian = Matrix::Zero(m, n);
  for (int c = 0; c < plan.columns; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
      jacobian(plan.jacobian.row_index[at(k)], c) = values[at(k)];
  }
  evaluator.applied_forces(rest, loads);
  Vector force(n), mass(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    force[c] = loads[at(coordinate)];
    const auto& body = evaluator.model().bodies[at(plan.model_body[at(coordinate / 3)])];
    mass[c] = coordinate % 3 == 2 ? body.inertia : body.mass;
  }
  std::vector<double> lambda(at(m), 0.0);
  Matrix basis = Matrix::Identity(n, n);
  if (m > 0) {
    // Phi_q is given to double precision: what it has of rank below that is rounding.
    const DenseRows<long double> rows(jacobian, 1e-12L);
    const Vector multipliers = rows.multipliers(force);
    std::copy(multipliers.data(), multipliers.data() + m, lambda.begin());
    basis = rows.null_space();
  }
  Matrix stiffness = Matrix::Zero(n, n);
  const auto add = [&](int body_i, int body_j, const auto& element) {
    const int body[2] = {body_i, body_j};
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) {
        const int b = body[r / 3], d = body[c / 3];
        if (b < 0 || d < 0 || b >= plan.moving || d >= plan.moving) continue;
        const int row = plan.column[at(3 * b + r % 3)], column = plan.column[at(3 * d + c % 3)];
        if (row >= 0 && column >= 0) stiffness(row, column) += element[at(6 * r + c)];
      }
    }
  };
  evaluator.visit_stiffness({}, add);
  evaluator.visit_constraint_hessians(lambda, add);
  const Matrix k = basis.transpose() * stiffness * basis, mm = basis.transpose() * mass.asDiagonal() * basis;
  const std::vector<long double> omega2 = generalized_eigenvalues<long double>(k, mm);
  return {omega2.begin(), omega2.end()};
}

}  // namespace catena::testing
