#include "catena/analysis/contact/shared_forces.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace catena {
namespace {

// Of the largest singular value of rows scaled to one: what dependent rows leave.
constexpr double no_response = 1e-11;
// Of the length of a null vector: entries that rounding leaves.
constexpr double no_share = 1e-9;
// Limits that meet in one point: 12 of 4 columns have 792 such points. More are left to the single places.
constexpr std::size_t most_freedom = 4;

std::vector<double> numbers(const Eigen::VectorXd& of) { return {of.begin(), of.end()}; }

}  // namespace

SharedForces::SharedForces(const ContactProblem& problem, const std::vector<std::size_t>& point) {
  using State = ContactProblem::State;
  struct Held {
    std::size_t place;
    bool along;
    double friction;  // of x along that one unit of x across makes, where it slides
  };
  std::vector<Held> held;
  for (std::size_t k = 0; k < problem.place.size(); ++k) {
    if (problem.state[k] == State::open) continue;
    const ContactProblem::Place& p = problem.place[k];
    if (p.head >= 0) continue;  // tensions beside grips are no cone: ContactSwitch::tie_grips()
    const bool slides = problem.state[k] == State::slides && p.has_friction;
    if (p.has_normal) held.push_back({k, false, slides ? -p.mu * problem.direction[k] : 0});
    if (problem.state[k] == State::sticks) held.push_back({k, true, 0});
  }
  const auto size = static_cast<Eigen::Index>(held.size());
  if (size < 2) return;
  const auto row_of = [&](Eigen::Index r) {
    const Held& h = held[static_cast<std::size_t>(r)];
    return 2 * h.place + (h.along ? 1 : 0);
  };
  Eigen::VectorXd unit(size);
  for (Eigen::Index r = 0; r < size; ++r) {
    const double own = problem.D(row_of(r), row_of(r));
    unit(r) = own > 0 ? 1 / std::sqrt(own) : 0;
  }
  Eigen::MatrixXd response(size, size);
  for (Eigen::Index r = 0; r < size; ++r) {
    for (Eigen::Index c = 0; c < size; ++c) {
      const Held& h = held[static_cast<std::size_t>(c)];
      response(r, c) =
          unit(r) * unit(c) * (problem.D(row_of(r), row_of(c)) + h.friction * problem.D(row_of(r), 2 * h.place + 1));
    }
  }
  // Nearly always there is nothing to share, which this tells soonest.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
  factors.setThreshold(no_response);
  if (factors.compute(response).rank() == size) return;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(response, Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  const Eigen::Index rank = (values.array() > no_response * values(0)).count();
  freedom_ = static_cast<std::size_t>(size - rank);
  if (freedom_ < 1 || freedom_ > most_freedom) return;
  const Eigen::MatrixXd free = unit.asDiagonal() * svd.matrixV().rightCols(size - rank);
  const double share = no_share * free.rowwise().norm().maxCoeff();
  const auto row = [&](std::size_t place, bool along) -> Eigen::VectorXd {
    for (Eigen::Index r = 0; r < size; ++r) {
      const Held& h = held[static_cast<std::size_t>(r)];
      if (h.place == place && h.along == along) return free.row(r);
    }
    return Eigen::VectorXd::Zero(size - rank);
  };
  for (std::size_t k = 0; k < problem.place.size(); ++k) {
    const ContactProblem::Place& p = problem.place[k];
    const Eigen::VectorXd normal = row(k, false), along = row(k, true);
    // Of joints what presses follows from other reactions: they are watched one by one.
    if (!p.has_normal || normal.norm() + along.norm() <= share) continue;
    places_.push_back(point[k]);
    if (problem.state[k] == State::sticks) {
      for (const double sign : {1.0, -1.0})
        limits_.push_back({point[k], p.mu_static, sign, numbers(p.mu_static * normal + sign * along)});
    } else {
      limits_.push_back({point[k], 1, 0, numbers(normal)});
    }
  }
  if (places_.size() < 2) places_.clear();
}

SharedForces::Best SharedForces::best(const std::function<double(std::size_t)>& normal,
                                      const std::function<double(std::size_t)>& along) const {
  const std::size_t count = limits_.size(), meet = std::min(freedom_ + 1, count);
  std::vector<double> given(count);
  for (std::size_t l = 0; l < count; ++l) {
    const Limit& limit = limits_[l];
    given[l] = limit.mu * normal(limit.point) + (limit.sign != 0 ? limit.sign * along(limit.point) : 0);
  }
  // Forces that may grow without end keep every limit far out.
  for (std::size_t k = 0; k < freedom_; ++k) {
    for (const double way : {1.0, -1.0}) {
      if (std::all_of(limits_.begin(), limits_.end(), [&](const Limit& l) { return way * l.slope[k] > 0; }))
        return {std::numeric_limits<double>::max(), {}};
    }
  }
  const auto columns = static_cast<Eigen::Index>(freedom_);
  const auto least_at = [&](const Eigen::VectorXd& y) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < count; ++l)
      least = std::min(least, given[l] + Eigen::Map<const Eigen::VectorXd>(limits_[l].slope.data(), columns).dot(y));
    return least;
  };
  Best best{*std::min_element(given.begin(), given.end()), {}};
  // Every choice of limits that meet, in lexical order.
  std::vector<std::size_t> chosen(meet);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  Eigen::MatrixXd A(static_cast<Eigen::Index>(meet), columns + 1);
  Eigen::VectorXd right(A.rows());
  while (true) {
    for (std::size_t k = 0; k < meet; ++k) {
      const auto r = static_cast<Eigen::Index>(k);
      for (Eigen::Index column = 0; column < columns; ++column)
        A(r, column) = limits_[chosen[k]].slope[static_cast<std::size_t>(column)];
      A(r, columns) = -1;
      right(r) = -given[chosen[k]];
    }
    const Eigen::VectorXd meeting = A.fullPivLu().solve(right);
    const double margin = meeting.allFinite() ? least_at(meeting.head(columns)) : best.margin;
    if (margin > best.margin || (margin == best.margin && best.limits.empty())) best = {margin, chosen};
    std::size_t k = meet;
    while (k > 0 && chosen[k - 1] == count - meet + k - 1) --k;
    if (k == 0) return best;
    ++chosen[k - 1];
    for (std::size_t next = k; next < meet; ++next) chosen[next] = chosen[next - 1] + 1;
  }
}

double SharedForces::margin(const std::function<double(std::size_t)>& normal,
                            const std::function<double(std::size_t)>& along) const {
  return best(normal, along).margin;
}

// Weights w >= 0 with sum w slope = 0, sum w = 1 of the limits that meet: those of weight zero only happen to be there.
std::vector<GivesWay> SharedForces::giving_way(const std::function<double(std::size_t)>& normal,
                                               const std::function<double(std::size_t)>& along) const {
  const std::vector<std::size_t> meeting = best(normal, along).limits;
  std::vector<GivesWay> places;
  if (meeting.empty()) return places;
  const auto columns = static_cast<Eigen::Index>(meeting.size()), rows = static_cast<Eigen::Index>(freedom_) + 1;
  Eigen::MatrixXd A(rows, columns);
  for (Eigen::Index column = 0; column < columns; ++column) {
    const Limit& limit = limits_[meeting[static_cast<std::size_t>(column)]];
    for (Eigen::Index r = 0; r + 1 < rows; ++r) A(r, column) = limit.slope[static_cast<std::size_t>(r)];
    A(rows - 1, column) = 1;
  }
  const Eigen::VectorXd weight = A.fullPivLu().solve(Eigen::VectorXd::Unit(rows, rows - 1));
  for (Eigen::Index column = 0; column < columns; ++column) {
    const Limit& limit = limits_[meeting[static_cast<std::size_t>(column)]];
    // T = -mu N, which the first of both limits of a place is, goes with a slip forwards.
    if (weight(column) > no_share) places.push_back({limit.point, static_cast<int>(limit.sign)});
  }
  return places;
}

}  // namespace catena
