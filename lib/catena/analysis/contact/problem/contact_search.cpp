// States of a ContactProblem by trial: for every place whether it sticks, slides one way or the other, or is open.
//
// With given states the forces are columns with coefficients that are not negative - of a place that sticks the two
// edges of its cone, J_n +- mu_static J_t, of one that slides or only presses its one edge -, which have to keep closed
// gaps closed and stuck slides at rest: least squares with a residual of nothing (nonnegative_least_squares.hpp). So it
// does not matter which of several forces that sticking places could share are looked at. States fit if open gaps do
// not close then, and slides from rest go the way that was meant. The more places stick, the earlier a choice is tried:
// what can be held is at rest.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "catena/analysis/contact/problem/contact_problem.hpp"
#include "catena/analysis/contact/problem/same_slides.hpp"
#include "catena/linalg/rank/nonnegative_least_squares.hpp"

namespace catena {
namespace {

/// The entries of a vector, or of a matrix column by column.
template <class M>
auto entries(M& of) {
  return std::span(of.data(), static_cast<std::size_t>(of.size()));
}

}  // namespace

// Whether what sticks or could stick depends on each other, so that its forces are not unique.
bool ContactProblem::sticks_together() const {
  std::vector<std::size_t> rows;
  int at_rest = 0;
  for (std::size_t k = 0; k < place.size(); ++k) {
    if (state[k] == State::open) continue;
    const bool rests = place[k].has_friction && place[k].slip == 0;
    at_rest += rests;
    if (place[k].has_normal) rows.push_back(2 * k);
    if (rests) rows.push_back(2 * k + 1);
  }
  if (at_rest < 2 || has_grips_) return false;
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd held(size, size);
  for (Eigen::Index r = 0; r < size; ++r) {
    const std::size_t row = rows[static_cast<std::size_t>(r)];
    for (Eigen::Index c = 0; c < size; ++c) {
      const std::size_t column = rows[static_cast<std::size_t>(c)];
      held(r, c) = unit(row) * unit(column) * D(row, column);
    }
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
  factors.setThreshold(no_response);
  return factors.compute(held).rank() < size;
}

// Whether the places are more than can be searched; those of ropes are found by sweeps alone.
bool ContactProblem::is_many() const { return place.size() > most_searched && !has_grips_; }

// Whether the present states fit; x is then what goes with them.
bool ContactProblem::try_states() {
  struct Edge {
    std::size_t place;
    double normal, along;  // of x that one unit of it makes
  };
  std::vector<Edge> columns;
  std::vector<double> known(x.size(), 0.0);
  std::vector<std::size_t> held;
  for (std::size_t k = 0; k < place.size(); ++k) {
    const Place& p = place[k];
    if (state[k] == State::open) continue;
    if (p.has_normal) held.push_back(2 * k);
    if (state[k] == State::sticks) {
      held.push_back(2 * k + 1);
      if (p.has_normal) {
        columns.push_back({k, 1, p.mu_static});
        columns.push_back({k, 1, -p.mu_static});
      } else {
        known[2 * k + 1] = -p.limit;
        columns.push_back({k, 0, 1});
      }
    } else if (p.has_normal) {
      columns.push_back({k, 1, p.has_friction ? -p.mu * direction[k] : 0});
    } else {
      known[2 * k + 1] = -direction[k] * p.kinetic;
    }
  }
  Eigen::MatrixXd A(static_cast<Eigen::Index>(held.size()), static_cast<Eigen::Index>(columns.size()));
  Eigen::VectorXd right(A.rows());
  for (Eigen::Index r = 0; r < A.rows(); ++r) {
    const std::size_t row = held[static_cast<std::size_t>(r)];
    // Rows across and along, and of places that turn, have different sizes.
    right(r) = b[row];
    for (std::size_t c = 0; c < known.size(); ++c) right(r) += D(row, c) * known[c];
    right(r) *= unit(row);
    for (Eigen::Index c = 0; c < A.cols(); ++c) {
      const Edge& of = columns[static_cast<std::size_t>(c)];
      A(r, c) = unit(row) * (D(row, 2 * of.place) * of.normal + D(row, 2 * of.place + 1) * of.along);
    }
  }
  Eigen::VectorXd sizes(A.cols());
  if (A.rows() > 0) nonnegative_least_squares(entries(A), entries(right), entries(sizes));
  x = known;
  for (Eigen::Index c = 0; c < A.cols(); ++c) {
    const Edge& of = columns[static_cast<std::size_t>(c)];
    x[2 * of.place] += of.normal * sizes(c);
    x[2 * of.place + 1] += of.along * sizes(c);
  }
  if (!keeps_states()) return false;
  LimitShares().share(*this);
  return keeps_limits();
}

// Whether x goes with the present states: closed gaps stay closed, stuck slides at rest, others go as they are meant
// to.
bool ContactProblem::keeps_states() const {
  for (std::size_t k = 0; k < place.size(); ++k) {
    for (const std::size_t along : {0, 1}) {
      const Place& p = place[k];
      if (along == 0 ? !p.has_normal : !p.has_friction || state[k] == State::open) continue;
      const auto [w, terms] = sum(2 * k + along);
      const double rounding = rounding_of_sums * terms;
      if (!std::isfinite(w)) return false;
      if (along == 0 && (state[k] == State::open ? w < -rounding : std::abs(w) > rounding)) return false;
      if (along == 0) continue;
      if (state[k] == State::sticks && std::abs(w) > rounding) return false;
      if (state[k] == State::slides && p.slip == 0 && direction[k] * w < -rounding) return false;
    }
  }
  return true;
}

// Whether joints that stick hold no more than they can.
bool ContactProblem::keeps_limits() const {
  for (std::size_t k = 0; k < place.size(); ++k) {
    const double most = place[k].limit * (1 + rounding_of_sums);
    if (state[k] == State::sticks && !place[k].has_normal && std::abs(x[2 * k + 1]) > most) return false;
  }
  return true;
}

bool ContactProblem::search() {
  if (place.size() > most_searched || has_grips_ || is_wedged()) return false;
  struct Trial {
    State state;
    int direction;
  };
  std::vector<std::vector<Trial>> choices(place.size());
  std::size_t count = 1;
  for (std::size_t k = 0; k < place.size(); ++k) {
    const Place& p = place[k];
    const bool presses = !p.has_normal || D(2 * k, 2 * k) > 0;
    if (presses && p.has_friction) {
      if (p.slip == 0) choices[k].push_back({State::sticks, 0});
      for (const int s : {1, -1}) {
        if (p.slip == 0 || p.slip == s) choices[k].push_back({State::slides, s});
      }
    } else if (presses && p.has_normal) {
      choices[k].push_back({State::slides, 0});
    }
    if (p.has_normal || !p.has_friction) choices[k].push_back({State::open, 0});
    count *= choices[k].size();
  }
  const std::vector<State> states = state;
  const std::vector<int> directions = direction;
  const std::vector<double> before = x;
  const auto take = [&](std::size_t number) {
    int moving = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
      const Trial& choice = choices[k][number % choices[k].size()];
      number /= choices[k].size();
      state[k] = choice.state;
      direction[k] = choice.direction;
      moving += choice.state != State::sticks;
    }
    return moving;
  };
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<int> moving(count);
  for (std::size_t number = 0; number < count; ++number) moving[number] = take(number);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t c) { return moving[a] < moving[c]; });
  for (const std::size_t number : order) {
    take(number);
    if (state == ruled_out_state_ && direction == ruled_out_direction_) continue;
    if (try_states()) return true;
  }
  state = states;
  direction = directions;
  x = before;
  return false;
}

}  // namespace catena
