// ContactProblem: its sums, their rounding, and what is compared with them.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/contact/problem/contact_problem.hpp"

namespace catena {

// Whether x keeps the inequalities of its states, to a part of its size or to the rounding of the sums that it answers:
// where little is hit beside what moves fast, that is more.
bool ContactProblem::fits(double size) const {
  for (std::size_t k = 0; k < place.size(); ++k) {
    const std::size_t n = 2 * k, t = n + 1;
    if (!std::isfinite(x[n]) || !std::isfinite(x[t])) return false;
    const bool sticks = state[k] == State::sticks;
    if (place[k].head >= 0) {
      if (sticks && size_of(t, misfit(k)) > rounding_of_sums * size) return false;
      continue;
    }
    const bool pulls = place[k].has_normal && size_of(n, x[n]) < -rounding_of_sums * size;
    if (pulls && size_of(n, x[n]) < -rounding_of_sums * sum(n).terms * unit(n)) return false;
    const double limit = place[k].has_normal ? place[k].mu_static * x[n] : place[k].limit;
    if (sticks && size_of(t, std::abs(x[t]) - limit) > rounding_of_sums * size) return false;
  }
  return true;
}

void ContactProblem::find_units() {
  for (std::size_t row = 0; row < units_.size(); ++row) {
    const Place& p = place[row / 2];
    const std::size_t of = p.head >= 0 ? 2 * static_cast<std::size_t>(p.head) : row;
    units_[row] = D(of, of) > 0 ? 1 / std::sqrt(D(of, of)) : 0;
  }
}

double ContactProblem::size_of(std::size_t row, double change) const {
  const double one = unit(row);
  return one > 0 ? change / one : 0;
}

double ContactProblem::size() const {
  double largest = 0;
  for (std::size_t r = 0; r < x.size(); ++r) largest = std::max(largest, size_of(r, std::abs(x[r])));
  return largest;
}

ContactProblem::Sum ContactProblem::sum(std::size_t row) const {
  Sum w{b[row], std::max(std::abs(b[row]), b_terms[row])};
  for (std::size_t c = 0; c < x.size(); ++c) {
    const double part = D(row, c) * x[c];
    w.value += part;
    w.terms += std::abs(part);
  }
  return w;
}

// Of x, without a unit: of the sums that it is the solution of.
double ContactProblem::rounding() const {
  double largest = 0;
  for (std::size_t r = 0; r < x.size(); ++r) {
    if (D(r, r) > 0) largest = std::max(largest, size_of(r, sum(r).terms / D(r, r)));
  }
  return std::numeric_limits<double>::epsilon() * static_cast<double>(x.size() + 2) * largest;
}

bool ContactProblem::is_carried(std::size_t k, double w_t) const {
  const std::size_t t = 2 * k + 1;
  return !(D(t, t) > 0) && std::abs(w_t) > rounding_of_sums * std::max(std::abs(b[t]), b_terms[t]);
}

// Whether a slip that is there already wedges a place: nothing fits, or a free and a pressed place fit alike.
bool ContactProblem::is_wedged() const {
  for (std::size_t k = 0; k < place.size(); ++k) {
    const Place& p = place[k];
    const double across = D(2 * k, 2 * k);
    if (!p.has_normal || !p.has_friction || p.slip == 0 || !(across > 0)) continue;
    if (!(across - p.mu * p.slip * D(2 * k, 2 * k + 1) > 0)) return true;
  }
  return false;
}

// What is left of it once the others are taken away, w = 0 in them.
bool ContactProblem::depends(std::size_t row, const std::vector<std::size_t>& others) const {
  const auto size = static_cast<Eigen::Index>(others.size());
  Eigen::MatrixXd of_others(size, size);
  Eigen::VectorXd d(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::size_t r = others[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < size; ++j) of_others(i, j) = D(r, others[static_cast<std::size_t>(j)]);
    d(i) = D(r, row);
  }
  const double left =
      size > 0 ? D(row, row) - d.dot(of_others.completeOrthogonalDecomposition().solve(d)) : D(row, row);
  return !(left > rounding_of_sums * D(row, row));
}

}  // namespace catena
