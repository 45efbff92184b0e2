#include "catena/analysis/contact/shared_forces.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace catena {
namespace {

// Of the largest singular value of rows scaled to one: what dependent rows leave.
constexpr double no_response = 1e-11;
// Of the length of a null vector: entries that rounding leaves.
constexpr double no_share = 1e-9;
// Columns of Z: 16 limits of eight feet and 4 columns have 4368 choices of five. More are left to the single places.
constexpr Eigen::Index most_freedom = 4;

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

/// Z, a row for each that holds; no columns where forces are unique.
Eigen::MatrixXd free_forces(const ContactProblem& problem, const std::vector<Held>& held) {
  const auto size = static_cast<Eigen::Index>(held.size());
  const auto at = [&](Eigen::Index r) -> const Held& { return held[static_cast<std::size_t>(r)]; };
  Eigen::VectorXd unit(size);
  for (Eigen::Index r = 0; r < size; ++r) {
    const double own = problem.D(at(r).row(), at(r).row());
    unit(r) = own > 0 ? 1 / std::sqrt(own) : 0;
  }
  Eigen::MatrixXd response(size, size);
  for (Eigen::Index r = 0; r < size; ++r) {
    for (Eigen::Index c = 0; c < size; ++c) {
      const Held& h = at(c);
      const double along = h.friction * problem.D(at(r).row(), 2 * h.place + 1);
      response(r, c) = unit(r) * unit(c) * (problem.D(at(r).row(), h.row()) + along);
    }
  }
  // Nearly always there is nothing to share, which this tells soonest.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
  factors.setThreshold(no_response);
  if (size < 2 || factors.compute(response).rank() == size) return Eigen::MatrixXd(size, 0);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(response, Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  const Eigen::Index rank = (values.array() > no_response * values(0)).count();
  return unit.asDiagonal() * svd.matrixV().rightCols(size - rank);
}

std::vector<double> numbers(const Eigen::VectorXd& of) { return {of.begin(), of.end()}; }

}  // namespace

SharedForces::SharedForces(const ContactProblem& problem, const std::vector<std::size_t>& point) {
  const std::vector<Held> held = held_rows(problem);
  const Eigen::MatrixXd free = free_forces(problem, held);
  if (free.cols() < 1 || free.cols() > most_freedom) return;
  const double share = no_share * free.rowwise().norm().maxCoeff();
  const auto row = [&](std::size_t place, bool along) -> Eigen::VectorXd {
    const auto found =
        std::find_if(held.begin(), held.end(), [&](const Held& h) { return h.place == place && h.along == along; });
    return found == held.end() ? Eigen::VectorXd::Zero(free.cols()) : Eigen::VectorXd(free.row(found - held.begin()));
  };
  std::vector<std::vector<double>> slope;  // by y, of limits_
  for (std::size_t k = 0; k < problem.place.size(); ++k) {
    const ContactProblem::Place& p = problem.place[k];
    const Eigen::VectorXd normal = row(k, false), along = row(k, true);
    // Of joints what presses follows from other reactions: they are watched one by one.
    if (!p.has_normal || normal.norm() + along.norm() <= share) continue;
    places_.push_back(point[k]);
    if (problem.state[k] == State::sticks) {
      for (const double sign : {1.0, -1.0}) {
        limits_.push_back({point[k], p.mu_static, sign});
        slope.push_back(numbers(p.mu_static * normal + sign * along));
      }
    } else {
      limits_.push_back({point[k], 1, 0});
      slope.push_back(numbers(normal));
    }
  }
  if (places_.size() < 2)
    places_.clear();
  else
    find_corners(slope);
}

// Corners are solutions of as many columns as [c; 1] has independent rows.
void SharedForces::find_corners(const std::vector<std::vector<double>>& slope) {
  const auto count = static_cast<Eigen::Index>(limits_.size()),
             freedom = static_cast<Eigen::Index>(slope.front().size());
  Eigen::MatrixXd A(freedom + 1, count);
  for (Eigen::Index l = 0; l < count; ++l) {
    for (Eigen::Index r = 0; r < freedom; ++r)
      A(r, l) = slope[static_cast<std::size_t>(l)][static_cast<std::size_t>(r)];
    A(freedom, l) = 1;
  }
  // A direction of y that no limit depends on asks for nothing.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
  factors.setThreshold(no_share);
  const Eigen::Index rank = factors.compute(A).rank();
  const Eigen::MatrixXd turned = factors.householderQ().transpose() * A;
  const Eigen::VectorXd right = factors.householderQ().transpose() * Eigen::VectorXd::Unit(freedom + 1, freedom);
  if (right.tail(freedom + 1 - rank).norm() > no_share) return;
  // Every choice of columns, in lexical order.
  const auto meet = static_cast<std::size_t>(rank), all = static_cast<std::size_t>(count);
  std::vector<std::size_t> chosen(meet);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  Eigen::MatrixXd square(rank, rank);
  while (true) {
    for (Eigen::Index c = 0; c < rank; ++c)
      square.col(c) = turned.col(static_cast<Eigen::Index>(chosen[static_cast<std::size_t>(c)])).head(rank);
    Eigen::FullPivLU<Eigen::MatrixXd> solver;
    solver.setThreshold(no_share);
    if (solver.compute(square).isInvertible()) {
      const Eigen::VectorXd weight = solver.solve(right.head(rank));
      Corner corner;
      for (Eigen::Index c = 0; c < rank; ++c) {
        if (weight(c) > no_share) corner.emplace_back(chosen[static_cast<std::size_t>(c)], weight(c));
      }
      const bool is_new = std::none_of(corners_.begin(), corners_.end(), [&](const Corner& other) {
        return std::equal(corner.begin(), corner.end(), other.begin(), other.end(),
                          [](const auto& a, const auto& b) { return a.first == b.first; });
      });
      if (weight.minCoeff() > -no_share && is_new) corners_.push_back(std::move(corner));
    }
    std::size_t k = meet;
    while (k > 0 && chosen[k - 1] == all - meet + k - 1) --k;
    if (k == 0) return;
    ++chosen[k - 1];
    for (std::size_t next = k; next < meet; ++next) chosen[next] = chosen[next - 1] + 1;
  }
}

}  // namespace catena
