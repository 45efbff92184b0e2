#include "catena/analysis/spectrum/modes_dense.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "catena/analysis/spectrum/mass_basis.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using Basis = Eigen::Map<Eigen::MatrixXd>;

Basis basis_of(MotionGroup& group) {
  return {group.basis.data(), static_cast<Eigen::Index>(group.columns.size()), group.freedoms()};
}

}  // namespace

DenseModes::DenseModes(StaticSystem& system, MotionGroups& groups, std::span<const double> mass,
                       const std::function<bool()>& go_on, std::span<const AddedSpring> added)
    : system_(system), groups_(groups), added_(added) {
  cancelled_ = !groups_.orthonormalise(basis_weights(system, groups_, mass), go_on);
  for (int k = 0; k < static_cast<int>(groups_.groups().size()) && !massless_ && !cancelled_; ++k) {
    MotionGroup& group = groups_.groups()[at(k)];
    if (group.freedoms() == 0) continue;
    massless_ = use_masses(system, group, mass);
    if (!massless_) solve(group, k, go_on);
  }
  std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.value < b.value; });
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
    Mode mode{.shape = std::vector<double>(product.size(), 0.0)};
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
