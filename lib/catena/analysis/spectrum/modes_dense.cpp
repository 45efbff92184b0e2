#include "catena/analysis/spectrum/modes_dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

using Basis = Eigen::Map<Eigen::MatrixXd>;

Basis basis_of(MotionGroup& group) {
  return {group.basis.data(), static_cast<Eigen::Index>(group.columns.size()), group.freedoms()};
}

// Part of a motion, in lengths, that must be that of coordinates with mass: the same measure as for ranks.
constexpr double least_part = 1e-10;

}  // namespace

DenseModes::DenseModes(StaticSystem& system, MotionGroups& groups, std::span<const double> mass,
                       const std::function<bool()>& go_on, std::span<const AddedSpring> added)
    : system_(system), groups_(groups), added_(added) {
  // Coordinates without mass get the weight of a length; their groups are made orthonormal in M below.
  std::vector<double> weight(mass.begin(), mass.end());
  for (const MotionGroup& group : groups_.groups()) {
    const bool complete =
        std::all_of(group.columns.begin(), group.columns.end(), [&](int c) { return mass[at(c)] > 0; });
    for (int c : group.columns) {
      const double arm = 1 / system.matrix().inverse_arms()[at(c)];
      if (!complete) weight[at(c)] = arm * arm;
    }
  }
  cancelled_ = !groups_.orthonormalise(weight, go_on);
  for (int k = 0; k < static_cast<int>(groups_.groups().size()) && !massless_ && !cancelled_; ++k) {
    MotionGroup& group = groups_.groups()[at(k)];
    if (group.freedoms() == 0 || !use_masses(group, mass)) continue;
    solve(group, k, go_on);
  }
  std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.value < b.value; });
}

// Z^T M Z = I by the QR decomposition of M^1/2 Z where some coordinates have no mass. False: there is no such basis.
bool DenseModes::use_masses(MotionGroup& group, std::span<const double> mass) {
  std::vector<int> heavy;
  for (int k = 0; k < static_cast<int>(group.columns.size()); ++k) {
    if (mass[at(group.columns[at(k)])] > 0) heavy.push_back(k);
  }
  if (heavy.size() == group.columns.size()) return true;
  Basis z = basis_of(group);
  Eigen::MatrixXd moved(static_cast<Eigen::Index>(heavy.size()), z.cols());
  for (std::size_t k = 0; k < heavy.size(); ++k) {
    const int c = group.columns[at(heavy[k])];
    moved.row(static_cast<Eigen::Index>(k)) = z.row(heavy[k]) / system_.matrix().inverse_arms()[at(c)];
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> geometry(moved.rows(), moved.cols());
  geometry.setThreshold(least_part);
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
      const double travel = std::abs(v[k]) / system_.matrix().inverse_arms()[at(c)];
      if (mass[at(c)] > 0 || travel <= most) continue;
      most = travel;
      largest = k;
    }
    massless_ = group.columns[static_cast<std::size_t>(largest)];
    return false;
  }
  for (std::size_t k = 0; k < heavy.size(); ++k) {
    moved.row(static_cast<Eigen::Index>(k)) = std::sqrt(mass[at(group.columns[at(heavy[k])])]) * z.row(heavy[k]);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(moved);
  const Eigen::MatrixXd r = factors.matrixR().topRows(z.cols()).triangularView<Eigen::Upper>();
  z = (z * factors.colsPermutation()).eval();
  r.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(z);
  return true;
}

void DenseModes::solve(MotionGroup& group, int number, const std::function<bool()>& go_on) {
  const auto stopped = [&] { return cancelled_ = go_on && !go_on(); };
  Basis z = basis_of(group);
  if (stopped()) return;
  reduce_stiffness(system_.matrix(), group, reduced_);
  for (const AddedSpring& spring : added_) {
    Eigen::VectorXd g(z.rows());
    for (Eigen::Index k = 0; k < g.size(); ++k) g[k] = spring.g[at(group.columns[static_cast<std::size_t>(k)])];
    const Eigen::VectorXd along = z.transpose() * g;
    Basis(reduced_.data(), z.cols(), z.cols()) += spring.k * along * along.transpose();
  }
  if (stopped()) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Basis(reduced_.data(), z.cols(), z.cols()));
  if (stopped()) return;
  ok_ = ok_ && solver.info() == Eigen::Success && solver.eigenvalues().allFinite();
  z = (z * solver.eigenvectors()).eval();
  for (Eigen::Index k = 0; k < z.cols(); ++k) {
    found_.push_back({solver.eigenvalues()[k], number, static_cast<int>(k)});
  }
}

std::vector<Mode> DenseModes::lowest(int count, const StiffnessFloor& floor) const {
  std::vector<Mode> modes;
  std::vector<double> product(at(system_.plan().columns));
  for (int k = 0; k < static_cast<int>(found_.size()); ++k) {
    const Found& found = found_[at(k)];
    if (k >= count && !modes.empty() && modes.back().omega2 > 0) break;
    const MotionGroup& group = groups_.groups()[at(found.group)];
    Mode mode{0, std::vector<double>(product.size(), 0.0)};
    const std::size_t n = group.columns.size();
    for (std::size_t c = 0; c < n; ++c) mode.shape[at(group.columns[c])] = group.basis[at(found.place) * n + c];
    system_.matrix().multiply_stiffness(mode.shape, product);
    for (std::size_t c = 0; c < product.size(); ++c) mode.omega2 += mode.shape[c] * product[c];
    for (const AddedSpring& spring : added_) {
      double along = 0;
      for (std::size_t c = 0; c < product.size(); ++c) along += spring.g[c] * mode.shape[c];
      mode.omega2 += spring.k * along * along;
    }
    if (std::abs(mode.omega2) <= floor(mode.shape)) mode.omega2 = 0;
    modes.push_back(std::move(mode));
  }
  std::stable_sort(modes.begin(), modes.end(), lower);
  return modes;
}

}  // namespace catena
