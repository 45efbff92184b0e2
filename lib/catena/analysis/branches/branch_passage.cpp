#include "catena/analysis/branches/branch_passage.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "catena/assembly/systems/tangent.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A combination with less than this of a row's length is near to losing it; the next one must have more.
constexpr double nearly_lost = 0.3;
// The square of that length at a place of the motion, where a combination always depends on others: rounding leaves
// 1e-15, and no step ends where one that is lost for an instant has less than 1e-7.
constexpr double always_lost = 1e-11;
// Length of the last step, and of the longest, length scales or rad: beyond it q_s is no neighbour of the passage.
constexpr double arrival = 1e-9, longest_step = 1;
constexpr int most_steps = 12;
// Rounding of residuals, in units of the coordinates: a few sums of products.
constexpr double few_roundings = 32 * std::numeric_limits<double>::epsilon();
// Eigenvalues of H below this part of the largest belong to motions that do not change the combination.
constexpr double unconcerned = 1e-6;

/// Equations of drivers are left out: branches of a mechanism meet where its other constraints lose rank, whoever moves
/// it.
class Passage {
 public:
  /// From `start` on, which is changed; `place`: one of the motion beside the passage.
  Passage(EquationsOfMotion& of, std::span<double> start, std::span<const double> place, std::span<double> phi,
          std::span<double> values);

  /// One step of Newton's method; c, H and Z are those of the place before it. False: there is no such place nearby, or
  /// several combinations are near to losing their gradients.
  bool approach(bool& arrived);

  EquationsOfMotion& equations;
  std::span<double> q;
  Eigen::VectorXd unit;            // of columns, m or rad
  Eigen::MatrixXd basis, hessian;  // Z over columns in these units, H
  double offset = 0;               // c
  bool several = false;

 private:
  Eigen::MatrixXd scaled_jacobian(std::span<const double> place, Eigen::VectorXd& scale);
  void keep_equations(std::span<const double> place);

  std::span<double> phi_, values_;
  Eigen::MatrixXd kept_;  // combinations of rows, orthonormal columns
};

Passage::Passage(EquationsOfMotion& of, std::span<double> start, std::span<const double> place, std::span<double> phi,
                 std::span<double> values)
    : equations(of), q(start), phi_(phi), values_(values) {
  const Plan& plan = of.plan();
  unit.resize(plan.columns);
  for (int c = 0; c < plan.columns; ++c) unit[c] = plan.coordinate[at(c)] % 3 == 2 ? 1 : of.evaluator().length_scale();
  of.evaluator().start_jacobian(values_);
  keep_equations(place);
}

// Rows of length one, in units of the columns, and what each was multiplied by: 0 for those of drivers.
Eigen::MatrixXd Passage::scaled_jacobian(std::span<const double> place, Eigen::VectorXd& scale) {
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = equations.plan();
  evaluator.set_configuration(place);
  evaluator.jacobian(values_);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(plan.rows, plan.columns);
  for (int c = 0; c < plan.columns; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
      jacobian(plan.jacobian.row_index[at(k)], c) = values_[at(k)] * unit[c];
  }
  scale = jacobian.rowwise().norm().unaryExpr([](double l) { return l > 0 ? 1 / l : 0; });
  const auto& elements = evaluator.model().elements;
  for (int r = 0; r < plan.rows; ++r) {
    if (elements[at(plan.row_element[at(r)])].kind == ElementKind::driver) scale[r] = 0;
  }
  return scale.asDiagonal() * jacobian;
}

// Keeps no combination of the rows that always depends on others: among these the one that only depends for an instant
// could not be told. Without drivers the motion knows which to leave out.
void Passage::keep_equations(std::span<const double> place) {
  const Plan& plan = equations.plan();
  const SparseVectors& out = equations.left_out();
  Eigen::VectorXd scale;
  const Eigen::MatrixXd jacobian = scaled_jacobian(place, scale);
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(plan.rows, (scale.array() == 0).count());
  for (Eigen::Index r = 0, k = 0; r < scale.size(); ++r) {
    if (scale[r] == 0) left(r, k++) = 1;
  }
  const Eigen::Index idle = left.cols();
  if (out.count() > 0 && plan.driver_rows > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(jacobian * jacobian.transpose());
    left = squares.eigenvectors().leftCols((squares.eigenvalues().array() < always_lost).count());
  } else if (out.count() > 0) {
    left.conservativeResize(Eigen::NoChange, idle + out.count());
    left.rightCols(out.count()).setZero();
    for (int k = 0; k < out.count(); ++k) {
      for (int n = out.start[at(k)]; n < out.start[at(k) + 1]; ++n) left(out.index[at(n)], idle + k) = out.value[at(n)];
    }
  }
  kept_ = Eigen::MatrixXd::Zero(plan.rows, plan.rows - left.cols());
  kept_.bottomRows(kept_.cols()).setIdentity();
  if (left.cols() > 0) kept_.applyOnTheLeft(Eigen::HouseholderQR<Eigen::MatrixXd>(left).householderQ());
}

// One step of Newton's method towards q_s; c, H and Z are those of the place before it.
bool Passage::approach(bool& arrived) {
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = equations.plan();
  Eigen::VectorXd scale;
  const Eigen::MatrixXd jacobian = kept_.transpose() * scaled_jacobian(q, scale);
  evaluator.phi(phi_);
  const Eigen::VectorXd phi =
      kept_.transpose() * scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(phi_.data(), plan.rows));
  // Ascending: the combination that nearly depends on the others, the rest.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(jacobian * jacobian.transpose());
  const Eigen::Index rest = kept_.cols() - 1, free = plan.columns - rest;
  const auto& value = squares.eigenvalues();
  if (rest < 0 || free < 1 || !(value[0] < nearly_lost * nearly_lost)) return false;
  several = rest > 0 && value[1] < nearly_lost * nearly_lost && value[1] < 100 * value[0];
  if (several) return false;
  const Eigen::VectorXd w = squares.eigenvectors().col(0);
  const Eigen::MatrixXd others = jacobian.transpose() * squares.eigenvectors().rightCols(rest);
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(others);
  basis = Eigen::MatrixXd::Zero(plan.columns, free);
  basis.bottomRows(free).setIdentity();
  if (rest > 0) basis.applyOnTheLeft(factors.householderQ());
  const Eigen::VectorXd lambda = scale.cwiseProduct(kept_ * w);
  Eigen::MatrixXd bend = Eigen::MatrixXd::Zero(plan.columns, plan.columns);
  visit_curvature(evaluator, std::span(lambda.data(), at(plan.rows)), [&](int i, int j, double entry) {
    const int row = plan.column[at(i)], column = plan.column[at(j)];
    if (row >= 0 && column >= 0) bend(row, column) += entry * unit[row] * unit[column];
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

}  // namespace

BranchMeeting find_branch_meeting(EquationsOfMotion& equations, std::span<double> q, std::span<const double> place,
                                  std::span<double> phi, std::span<double> values, BranchCorner& corner) {
  const Plan& plan = equations.plan();
  Passage passage(equations, q, place, phi, values);
  double extent = std::numbers::pi;  // of angles, out of which whole turns are taken
  for (int c = 0; c < plan.columns; ++c) {
    const int k = plan.coordinate[at(c)];
    if (k % 3 != 2) extent = std::max(extent, std::abs(place[at(k)]) / passage.unit[c]);
  }
  bool arrived = false;
  for (int k = 0; k < most_steps && !arrived; ++k) {
    if (!passage.approach(arrived)) return passage.several ? BranchMeeting::several : BranchMeeting::none;
  }
  if (!arrived) return BranchMeeting::none;
  corner = {std::abs(passage.offset), few_roundings * extent, 0, {}};
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
  if (!(corner.offset > corner.rounding))
    return of_its_sign > 0 && against > 0 ? BranchMeeting::crossing : BranchMeeting::none;
  if (of_its_sign != 1 || against == 0) return BranchMeeting::none;
  corner.gap = std::sqrt(2 * corner.offset / std::abs(value[own]));
  const Eigen::VectorXd direction = passage.basis * curvature.eigenvectors().col(own);
  for (int c = 0; c < plan.columns; ++c) corner.direction.push_back(direction[c] / passage.unit[c]);
  return BranchMeeting::corner;
}

}  // namespace catena
