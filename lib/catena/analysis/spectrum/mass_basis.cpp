#include "catena/analysis/spectrum/mass_basis.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
std::vector<double> basis_weights(StaticSystem& system, const MotionGroups& groups, std::span<const double> mass) {
  std::vector<double> weight(mass.begin(), mass.end());
  for (const MotionGroup& group : groups.groups()) {
    const bool complete =
        std::all_of(group.columns.begin(), group.columns.end(), [&](int c) { return mass[at(c)] > 0; });
    for (int c : group.columns) {
      const double arm = 1 / system.matrix().inverse_arms()[at(c)];
      if (!complete) weight[at(c)] = arm * arm;
    }
  }
  return weight;
}

std::optional<int> use_masses(StaticSystem& system, MotionGroup& group, std::span<const double> mass) {
  std::vector<int> heavy;
  for (int k = 0; k < static_cast<int>(group.columns.size()); ++k) {
    if (mass[at(group.columns[at(k)])] > 0) heavy.push_back(k);
  }
  if (heavy.size() == group.columns.size()) return {};
  Eigen::Map<Eigen::MatrixXd> z(group.basis.data(), static_cast<Eigen::Index>(group.columns.size()), group.freedoms());
  Eigen::MatrixXd moved(static_cast<Eigen::Index>(heavy.size()), z.cols());
  for (std::size_t k = 0; k < heavy.size(); ++k) {
    const int c = group.columns[at(heavy[k])];
    moved.row(static_cast<Eigen::Index>(k)) = z.row(heavy[k]) / system.matrix().inverse_arms()[at(c)];
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> geometry(moved.rows(), moved.cols());
  // The part of a motion, in lengths, that must be that of coordinates with mass.
  geometry.setThreshold(dependence::follows);
  geometry.compute(moved);
  if (geometry.rank() < z.cols()) {
    // The motion that pivoting found last moves no mass: its largest massless coordinate.
    const Eigen::Index rank = geometry.rank();
    Eigen::VectorXd y = Eigen::VectorXd::Zero(z.cols());
    if (rank > 0) {
      y.head(rank) = geometry.matrixR()
                         .topLeftCorner(rank, rank)
                         .triangularView<Eigen::Upper>()
                         .solve(-geometry.matrixR().col(rank).head(rank));
    }
    y[rank] = 1;
    const Eigen::VectorXd v = z * (geometry.colsPermutation() * y);
    Eigen::Index largest = -1;
    double most = -1;
    for (Eigen::Index k = 0; k < v.size(); ++k) {
      const int c = group.columns[static_cast<std::size_t>(k)];
      const double travel = std::abs(v[k]) / system.matrix().inverse_arms()[at(c)];
      if (mass[at(c)] > 0 || travel <= most) continue;
      most = travel;
      largest = k;
    }
    return group.columns[static_cast<std::size_t>(largest)];
  }
  for (std::size_t k = 0; k < heavy.size(); ++k) {
    moved.row(static_cast<Eigen::Index>(k)) = std::sqrt(mass[at(group.columns[at(heavy[k])])]) * z.row(heavy[k]);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(moved);
  const Eigen::MatrixXd r = factors.matrixR().topRows(z.cols()).triangularView<Eigen::Upper>();
  z = (z * factors.colsPermutation()).eval();
  r.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(z);
  return {};
}

}  // namespace catena
