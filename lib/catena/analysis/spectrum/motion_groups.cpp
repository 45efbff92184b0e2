#include "catena/analysis/spectrum/motion_groups.hpp"

#include <Eigen/QR>
#include <cmath>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/base/at.hpp"
#include "catena/model/disjoint_sets.hpp"

namespace catena {
namespace {

// Columns up to which dense algebra takes about a second whatever the freedoms.
constexpr int most_columns = 2000;

}  // namespace

MotionGroups::MotionGroups(StaticSystem& system, bool split) : system_(system) {
  const Plan& plan = system.plan();
  const int columns = plan.columns;
  const std::span<const double> jacobian = system.jacobian();
  std::vector<int> independent;
  if (plan.rows > 0) {
    RankOptions options;
    options.most_dependencies = options.most_null_vectors = 0;
    independent = jacobian_rank(system.evaluator(), plan.jacobian, jacobian, options).independent_rows;
  }
  DisjointSets ties(columns + plan.rows);
  const SparsePattern& pattern = system.matrix().structure().pattern;
  const std::span<const double> values = system.matrix().values();
  for (int c = 0; c < columns; ++c) {
    if (!split && c > 0) ties.join(c, c - 1);
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      if (jacobian[at(k)] != 0) ties.join(c, columns + plan.jacobian.row_index[at(k)]);
    }
    for (int k = pattern.column_start[at(c)]; split && k < pattern.column_start[at(c) + 1]; ++k) {
      const int r = pattern.row_index[at(k)];
      if (r < columns && values[at(k)] != 0) ties.join(c, r);
    }
  }
  std::vector<int> group_of(at(columns + plan.rows), -1);
  for (int c = 0; c < columns; ++c) {
    int& group = group_of[at(ties.root(c))];
    if (group < 0) {
      group = static_cast<int>(groups_.size());
      groups_.emplace_back();
    }
    groups_[at(group)].columns.push_back(c);
  }
  for (int r : independent) {
    const int group = group_of[at(ties.root(columns + r))];
    if (group >= 0) groups_[at(group)].rows.push_back(r);
  }
}

bool MotionGroups::are_small(int most_freedoms) const {
  return std::all_of(groups_.begin(), groups_.end(), [&](const MotionGroup& g) {
    return g.freedoms() <= most_freedoms && static_cast<int>(g.columns.size()) <= most_columns;
  });
}

int MotionGroups::freedoms() const {
  int sum = 0;
  for (const MotionGroup& g : groups_) sum += g.freedoms();
  return sum;
}

bool MotionGroups::orthonormalise(std::span<const double> weight, const std::function<bool()>& go_on) {
  const Plan& plan = system_.plan();
  const std::span<const double> jacobian = system_.jacobian();
  std::vector<int> place(at(plan.rows), -1);
  for (MotionGroup& g : groups_) {
    if (go_on && !go_on()) return false;
    const auto n = static_cast<Eigen::Index>(g.columns.size()), r = static_cast<Eigen::Index>(g.rows.size());
    Eigen::VectorXd scale(n);
    for (Eigen::Index c = 0; c < n; ++c) scale[c] = 1 / std::sqrt(weight[at(g.columns[static_cast<std::size_t>(c)])]);
    g.basis.resize(static_cast<std::size_t>(n * (n - r)));
    Eigen::Map<Eigen::MatrixXd> basis(g.basis.data(), n, n - r);
    basis.setZero();
    basis.bottomRows(n - r).setIdentity();
    if (r > 0) {
      Eigen::MatrixXd transposed = Eigen::MatrixXd::Zero(n, r);
      for (Eigen::Index k = 0; k < r; ++k) place[at(g.rows[static_cast<std::size_t>(k)])] = static_cast<int>(k);
      for (Eigen::Index c = 0; c < n; ++c) {
        const int column = g.columns[static_cast<std::size_t>(c)];
        for (int k = plan.jacobian.column_start[at(column)]; k < plan.jacobian.column_start[at(column) + 1]; ++k) {
          const int row = place[at(plan.jacobian.row_index[at(k)])];
          if (row >= 0) transposed(c, row) = scale[c] * jacobian[at(k)];
        }
      }
      for (Eigen::Index k = 0; k < r; ++k) {
        place[at(g.rows[static_cast<std::size_t>(k)])] = -1;
        // Rows of one length: squared forms and forms in radians count alike.
        transposed.col(k).normalize();
      }
      const Eigen::HouseholderQR<Eigen::MatrixXd> factors(transposed);
      if (go_on && !go_on()) return false;
      basis.applyOnTheLeft(factors.householderQ());
    }
    basis = scale.asDiagonal() * basis;
  }
  return true;
}

void reduce_stiffness(const KktMatrix& matrix, const MotionGroup& group, std::vector<double>& reduced) {
  const KktStructure& structure = matrix.structure();
  const SparsePattern& pattern = structure.pattern;
  const auto n = static_cast<Eigen::Index>(group.columns.size()), f = static_cast<Eigen::Index>(group.freedoms());
  const Eigen::Map<const Eigen::MatrixXd> z(group.basis.data(), n, f);
  // By rows of Z: entries of K then multiply neighbouring values.
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = z;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> product(n, f);
  product.setZero();
  std::vector<int> place(at(structure.columns), -1);
  for (Eigen::Index k = 0; k < n; ++k) place[at(group.columns[static_cast<std::size_t>(k)])] = static_cast<int>(k);
  for (Eigen::Index k = 0; k < n; ++k) {
    const int c = group.columns[static_cast<std::size_t>(k)];
    for (int s = pattern.column_start[at(c)]; s < pattern.column_start[at(c) + 1]; ++s) {
      const int r = pattern.row_index[at(s)];
      const double value = matrix.values()[at(s)];
      if (r >= structure.columns || value == 0) continue;
      product.row(place[at(r)]) += value * rows.row(k);
      if (r != c) product.row(k) += value * rows.row(place[at(r)]);
    }
  }
  reduced.resize(static_cast<std::size_t>(f * f));
  Eigen::Map<Eigen::MatrixXd>(reduced.data(), f, f).noalias() = rows.transpose() * product;
}

}  // namespace catena
