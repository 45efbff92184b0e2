#include "catena/analysis/dynamics/integrators/branch_keeping.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// A combination with less than this of a row's length is near to losing it; the next one must have more.
constexpr double nearly_lost = 0.3;
constexpr int most_steps = 12;
// Length of the last step, and of the longest, length scales or rad: beyond it q_s is no neighbour of the passage.
constexpr double arrival = 1e-9, longest_step = 1;
// Eigenvalues of H below this part of the largest belong to motions that do not change the combination.
constexpr double unconcerned = 1e-6;
// Rounding of residuals, in units of the coordinates: a few sums of products.
constexpr double few_roundings = 32 * std::numeric_limits<double>::epsilon();
// The corner that a motion turns at is as near as c says: where rounding changes c by a larger part of it no step can
// follow it, and it is crossed as if c were zero. Four-bars that differ from parallel cranks by 1e-10 of a rod and more
// turn at tolerances from 1e-4 to 1e-10; by 6e-11 and less they stall or need 33 000 steps in place of 37.
constexpr double largest_rounding_of_offset = 5e-4;

/// The search for q_s, and what is known there.
class Passage {
 public:
  Passage(EquationsOfMotion& of, std::span<double> start, std::span<double> phi, std::span<double> values)
      : equations(of), q(start), phi_(phi), values_(values) {
    const Plan& plan = of.plan();
    unit.resize(plan.columns);
    for (int c = 0; c < plan.columns; ++c)
      unit[c] = plan.coordinate[at(c)] % 3 == 2 ? 1 : of.evaluator().length_scale();
    of.evaluator().start_jacobian(values_);
  }

  bool approach(bool& arrived);
  double along(const Eigen::VectorXd& direction, std::span<const double> place) const;

  EquationsOfMotion& equations;
  std::span<double> q;
  Eigen::VectorXd unit;            // of columns, m or rad
  Eigen::MatrixXd basis, hessian;  // Z over columns in these units, H
  double offset = 0;               // c

 private:
  std::span<double> phi_, values_;
};

// One step of Newton's method towards q_s; c, H and Z are those of the place before it.
bool Passage::approach(bool& arrived) {
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = equations.plan();
  evaluator.set_configuration(q);
  evaluator.phi(phi_);
  evaluator.jacobian(values_);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(plan.rows, plan.columns);
  for (int c = 0; c < plan.columns; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
      jacobian(plan.jacobian.row_index[at(k)], c) = values_[at(k)] * unit[c];
  }
  const Eigen::VectorXd scale = jacobian.rowwise().norm().unaryExpr([](double l) { return l > 0 ? 1 / l : 0; });
  jacobian = scale.asDiagonal() * jacobian;
  const Eigen::VectorXd phi = scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(phi_.data(), plan.rows));
  // Ascending: those that always depend on others, the one that nearly does, the rest.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(jacobian * jacobian.transpose());
  const Eigen::Index idle = (scale.array() == 0).count() + equations.left_out().count();
  const Eigen::Index rest = plan.rows - idle - 1, free = plan.columns - rest;
  const auto& value = squares.eigenvalues();
  if (rest < 0 || free < 1 || !(value[idle] < nearly_lost * nearly_lost)) return false;
  if (rest > 0 && value[idle + 1] < nearly_lost * nearly_lost && value[idle + 1] < 100 * value[idle]) return false;
  const Eigen::VectorXd w = squares.eigenvectors().col(idle);
  const Eigen::MatrixXd others = jacobian.transpose() * squares.eigenvectors().rightCols(rest);
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(others);
  basis = Eigen::MatrixXd::Zero(plan.columns, free);
  basis.bottomRows(free).setIdentity();
  if (rest > 0) basis.applyOnTheLeft(factors.householderQ());
  const Eigen::VectorXd lambda = scale.cwiseProduct(w);
  Eigen::MatrixXd bend = Eigen::MatrixXd::Zero(plan.columns, plan.columns);
  evaluator.visit_constraint_hessians(std::span(lambda.data(), at(plan.rows)), [&](int i, int j, const auto& matrix) {
    const auto column = [&](int k) {
      const int body = k < 3 ? i : j;
      return body >= 0 && body < plan.moving ? plan.column[at(3 * body + k % 3)] : -1;
    };
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) {
        if (column(r) >= 0 && column(c) >= 0)
          bend(column(r), column(c)) += matrix[at(6 * r + c)] * unit[column(r)] * unit[column(c)];
      }
    }
  });
  hessian = basis.transpose() * bend * basis;
  offset = w.dot(phi);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> curvature(hessian);
  const double least = unconcerned * curvature.eigenvalues().cwiseAbs().maxCoeff();
  const Eigen::VectorXd slope = curvature.eigenvectors().transpose() * (basis.transpose() * (jacobian.transpose() * w));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(free);
  for (Eigen::Index k = 0; k < free; ++k) {
    if (std::abs(curvature.eigenvalues()[k]) > least) x[k] = -slope[k] / curvature.eigenvalues()[k];
  }
  Eigen::VectorXd step = basis * (curvature.eigenvectors() * x);
  if (rest > 0) {
    const Eigen::VectorXd missed = squares.eigenvectors().rightCols(rest).transpose() * phi;
    step -= others * missed.cwiseQuotient(value.tail(rest));
  }
  const double length = step.norm();
  if (!(length < longest_step)) return false;
  for (int c = 0; c < plan.columns; ++c) q[at(plan.coordinate[at(c)])] += unit[c] * step[c];
  arrived = length < arrival;
  return true;
}

double Passage::along(const Eigen::VectorXd& direction, std::span<const double> place) const {
  const Plan& plan = equations.plan();
  double sum = 0;
  for (int c = 0; c < plan.columns; ++c) {
    const std::size_t k = at(plan.coordinate[at(c)]);
    sum += direction[c] * (place[k] - q[k]) / unit[c];
  }
  return sum;
}

}  // namespace

BranchKeeping::BranchKeeping(const EquationsOfMotion& equations)
    : q_(at(equations.plan().coordinates())),
      phi_(at(equations.plan().rows)),
      values_(at(equations.plan().trash_slot()) + 1) {}

bool BranchKeeping::leaves(EquationsOfMotion& equations, std::span<const double> q0, std::span<const double> q1,
                           std::span<const double> middle) {
  const Plan& plan = equations.plan();
  if (plan.rows == 0 || plan.rows > most_rows) return false;
  std::copy(middle.begin(), middle.end(), q_.begin());
  Passage passage(equations, q_, phi_, values_);
  double extent = std::numbers::pi;  // of angles, out of which whole turns are taken
  for (int c = 0; c < plan.columns; ++c) {
    const int k = plan.coordinate[at(c)];
    if (k % 3 != 2) extent = std::max(extent, std::abs(q0[at(k)]) / passage.unit[c]);
  }
  bool arrived = false;
  for (int k = 0; k < most_steps && !arrived; ++k) {
    if (!passage.approach(arrived)) return false;
  }
  if (!arrived || !(largest_rounding_of_offset * std::abs(passage.offset) > few_roundings * extent)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> curvature(passage.hessian);
  const Eigen::VectorXd& value = curvature.eigenvalues();
  const double least = unconcerned * value.cwiseAbs().maxCoeff();
  Eigen::Index own = -1, of_its_sign = 0, against = 0;
  for (Eigen::Index k = 0; k < value.size(); ++k) {
    if (!(std::abs(value[k]) > least)) continue;
    if ((value[k] > 0) == (passage.offset < 0)) {
      ++of_its_sign;
      own = k;
    } else {
      ++against;
    }
  }
  if (of_its_sign != 1 || against == 0) return false;
  const Eigen::VectorXd direction = passage.basis * curvature.eigenvectors().col(own);
  gap_ = std::sqrt(2 * std::abs(passage.offset / value[own]));
  return passage.along(direction, q0) * passage.along(direction, q1) < 0;
}

}  // namespace catena
