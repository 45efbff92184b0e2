#include "catena/analysis/spectrum/motion_groups.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/base/at.hpp"
#include "catena/model/disjoint_sets.hpp"

namespace catena {
namespace {

// Columns up to which dense algebra takes about a second whatever the freedoms.
constexpr int most_columns = 2000;
// Parts of the uncancelled stiffness that rounding may leave. Multipliers come from solutions refined to 1e-15 or so of
// the largest; a value below a few hundred of these roundings cannot be distinguished from zero. Of coordinates far
// from the origin the last digits are unknown.
constexpr double stiffness_rounding = 2e-13, place_rounding = 4 * std::numeric_limits<double>::epsilon();

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

namespace {

// Calls f(a, b, K_ab) for every pair of moving coordinates in the stiffness of every element, forces and constraints.
template <class F>
void visit_entries(Evaluator& evaluator, std::span<const double> lambda, F&& f) {
  const int coordinates = 3 * evaluator.plan().moving;
  const auto element = [&](int body_i, int body_j, const auto& matrix) {
    const int body[2] = {body_i, body_j};
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) {
        const int row = 3 * body[r / 3] + r % 3, column = 3 * body[c / 3] + c % 3;
        if (std::min(row, column) >= 0 && std::max(row, column) < coordinates) f(row, column, matrix[at(6 * r + c)]);
      }
    }
  };
  evaluator.visit_stiffness({}, element);
  evaluator.visit_constraint_hessians(lambda, element);
}

}  // namespace

std::vector<double> body_arms(StaticSystem& system, std::span<const double> lambda) {
  const Plan& plan = system.plan();
  std::vector<double> travel(at(plan.rows), 0.0), turning(at(plan.moving), 0.0), pushing(turning), arms(turning);
  // Constraints: the distance from the body's origin to the point that they hold.
  for (const bool turns : {false, true}) {
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)];
      if ((coordinate % 3 == 2) != turns) continue;
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
        const double entry = std::abs(system.jacobian()[at(k)]);
        double& moved = travel[at(plan.jacobian.row_index[at(k)])];
        if (!turns) moved = std::max(moved, entry);
        if (turns && moved > 0) arms[at(coordinate / 3)] = std::max(arms[at(coordinate / 3)], entry / moved);
      }
    }
  }
  // Forces: the same, from the stiffness against both.
  visit_entries(system.evaluator(), lambda, [&](int row, int column, double value) {
    if (row != column) return;
    double& most = (row % 3 == 2 ? turning : pushing)[at(row / 3)];
    most = std::max(most, std::abs(value));
  });
  for (std::size_t b = 0; b < arms.size(); ++b) {
    if (!(arms[b] > 0) && pushing[b] > 0) arms[b] = std::sqrt(turning[b] / pushing[b]);
    if (!(arms[b] > 0)) arms[b] = system.length();
  }
  return arms;
}

StiffnessFloor::StiffnessFloor(StaticSystem& system, std::span<const double> lambda, double residual,
                               const MotionGroups* groups) {
  const Plan& plan = system.plan();
  Evaluator& evaluator = system.evaluator();
  const std::vector<double> arms = body_arms(system, lambda);
  // Per body, without cancellation: stiffness against travel, N/m, and against turning, N m.
  std::vector<double> travel(arms.size(), 0.0), turning(arms.size(), 0.0);
  visit_entries(evaluator, lambda, [&](int row, int column, double value) {
    const std::size_t b = at(row / 3), d = at(column / 3);
    const double size = std::abs(value);
    if (row % 3 == 2) {
      turning[b] += size * (column % 3 == 2 ? 1 : arms[b]);
    } else {
      travel[b] += size / (column % 3 == 2 ? arms[d] : 1);
    }
  });
  // Only the part of a pin's force across the arm enters K, but its rounding is that of the whole force.
  for (int c = 0; c < plan.columns; ++c) {
    const int coordinate = plan.coordinate[at(c)];
    if (coordinate % 3 == 2) continue;
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      const double force = std::abs(system.jacobian()[at(k)] * lambda[at(plan.jacobian.row_index[at(k)])]);
      turning[at(coordinate / 3)] += force * arms[at(coordinate / 3)];
    }
  }
  double farthest = 0;
  for (int b = 0; b < plan.moving; ++b) {
    const Frame<double> frame = evaluator.ground_frame(b);
    farthest = std::max({farthest, std::abs(frame.x), std::abs(frame.y)});
  }
  const double part = stiffness_rounding + place_rounding * farthest / system.length();
  // Shapes contain rounding too: every travel includes a little turning, and the other way round.
  for (std::size_t b = 0; b < arms.size(); ++b) travel[b] += turning[b] / (arms[b] * arms[b]);
  for (int coordinate : plan.coordinate) {
    const std::size_t b = at(coordinate / 3);
    floor_.push_back((coordinate % 3 == 2 ? arms[b] * arms[b] : 1) * (part * travel[b] + residual / arms[b]));
  }
  if (!groups) return;
  for (const MotionGroup& group : groups->groups()) {
    double stiffest = 0;
    for (int c : group.columns) stiffest = std::max(stiffest, travel[at(plan.coordinate[at(c)] / 3)]);
    for (int c : group.columns) {
      const double arm = plan.coordinate[at(c)] % 3 == 2 ? arms[at(plan.coordinate[at(c)] / 3)] : 1;
      floor_[at(c)] += place_rounding * stiffest * arm * arm;
    }
  }
}

double StiffnessFloor::operator()(std::span<const double> v) const {
  double sum = 0;
  for (std::size_t c = 0; c < floor_.size(); ++c) sum += floor_[c] * v[c] * v[c];
  return sum;
}

double StiffnessFloor::between(std::span<const double> u, std::span<const double> v) const {
  double sum = 0;
  for (std::size_t c = 0; c < floor_.size(); ++c) sum += floor_[c] * std::abs(u[c] * v[c]);
  return sum;
}

}  // namespace catena
