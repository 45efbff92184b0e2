#include "catena/analysis/contact/shared_forces.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace catena {
namespace {

using State = ContactProblem::State;

/// A row that holds: across a place, or along it.
struct Held {
  std::size_t place;
  bool along;
  double friction;  // of x along that one unit of x across makes, where it slides

  std::size_t row() const { return 2 * place + (along ? 1 : 0); }
};

std::vector<Held> held_rows(const ContactProblem& problem) {
  std::vector<Held> held;
  for (std::size_t k = 0; k < problem.place.size(); ++k) {
    const ContactProblem::Place& p = problem.place[k];
    // Tensions beside grips are no cone: ContactSwitch::tie_grips().
    if (problem.state[k] == State::open || p.head >= 0) continue;
    const bool slides = problem.state[k] == State::slides && p.has_friction;
    if (p.has_normal) held.push_back({k, false, slides ? -p.mu * problem.direction[k] : 0});
    if (problem.state[k] == State::sticks) held.push_back({k, true, 0});
  }
  return held;
}

/// Of a matrix with R = [R_1, R_2]: the columns of [-R_1^-1 R_2; 1], made orthonormal.
Eigen::MatrixXd null_space(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& factors, Eigen::Index rank) {
  const Eigen::Index size = factors.cols(), freedom = size - rank;
  Eigen::MatrixXd space(size, freedom);
  space.topRows(rank) = -factors.matrixR().topRightCorner(rank, freedom);
  factors.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(space.topRows(rank));
  space.bottomRows(freedom).setIdentity();
  const Eigen::MatrixXd turned = factors.colsPermutation() * space;
  return turned.householderQr().householderQ() * Eigen::MatrixXd::Identity(size, freedom);
}

/// Z, a row for each that holds; no columns where forces are unique.
Eigen::MatrixXd free_forces(const ContactProblem& problem, const std::vector<Held>& held) {
  const auto size = static_cast<Eigen::Index>(held.size());
  const auto at = [&](Eigen::Index r) -> const Held& { return held[static_cast<std::size_t>(r)]; };
  Eigen::VectorXd unit(size);
  for (Eigen::Index r = 0; r < size; ++r) unit(r) = problem.unit(at(r).row());
  Eigen::MatrixXd response(size, size);
  for (Eigen::Index r = 0; r < size; ++r) {
    for (Eigen::Index c = 0; c < size; ++c) {
      const Held& h = at(c);
      const double along = h.friction * problem.D(at(r).row(), 2 * h.place + 1);
      response(r, c) = unit(r) * unit(c) * (problem.D(at(r).row(), h.row()) + along);
    }
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
  factors.setThreshold(ContactProblem::no_response);
  const Eigen::Index rank = size < 2 ? size : factors.compute(response).rank();
  if (rank == size) return Eigen::MatrixXd(size, 0);
  return unit.asDiagonal() * null_space(factors, rank);
}

}  // namespace

SharedForces::SharedForces(const ContactProblem& problem, const std::vector<std::size_t>& point) {
  const std::vector<Held> held = held_rows(problem);
  const Eigen::MatrixXd free = free_forces(problem, held);
  if (free.cols() < 1) return;
  const double share = ContactProblem::rounding_of_sums * free.rowwise().norm().maxCoeff();
  const auto row = [&](std::size_t place, bool along) -> Eigen::VectorXd {
    const auto found =
        std::find_if(held.begin(), held.end(), [&](const Held& h) { return h.place == place && h.along == along; });
    return found == held.end() ? Eigen::VectorXd::Zero(free.cols()) : Eigen::VectorXd(free.row(found - held.begin()));
  };
  std::vector<double> columns;  // [c_l; 1] by limits
  const auto add = [&](const Limit& limit, const Eigen::VectorXd& slope) {
    limits_.push_back(limit);
    columns.insert(columns.end(), slope.begin(), slope.end());
    columns.push_back(1);
  };
  const auto sticks_with_others = [&](const Held& h) {
    return h.along && problem.place[h.place].has_normal && row(h.place, true).norm() > share;
  };
  const bool any_contact = std::any_of(held.begin(), held.end(), sticks_with_others);
  for (std::size_t k = 0; k < problem.place.size(); ++k) {
    const ContactProblem::Place& p = problem.place[k];
    const Eigen::VectorXd normal = row(k, false), along = row(k, true);
    // Joints that share with joints and stops alone: same_slides.hpp. What presses them follows from other reactions.
    if ((!p.has_normal && !any_contact) || normal.norm() + along.norm() <= share) continue;
    places_.push_back(point[k]);
    if (problem.state[k] == State::sticks) {
      for (const double sign : {1.0, -1.0}) add({point[k], p.mu_static, sign}, p.mu_static * normal + sign * along);
    } else {
      add({point[k], 1, 0}, normal);
    }
  }
  if (places_.size() < 2) {
    places_.clear();
    return;
  }
  const Eigen::VectorXd right = Eigen::VectorXd::Unit(free.cols() + 1, free.cols());
  shares_ = VertexMinimum(columns, {right.data(), static_cast<std::size_t>(right.size())});
}

}  // namespace catena
