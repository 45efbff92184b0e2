// ConstraintSolver: coordinates without mass, and solutions that are refined with the true masses.
#include <algorithm>
#include <cmath>
#include <random>

#include "catena/assembly/systems/constraint_solver.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Rounds in which a residual that shrinks to a half, at least, comes to rounding.
constexpr int most_massless_rounds = 52;
constexpr double massless_rounding = 1e-15;
// Of accelerations: what the next round would change.
constexpr double negligible = 1e-15;
constexpr int most_probes = 4;  // random loads: a coordinate that resists all of them is rare, and only costs rounds

}  // namespace

// The unbalanced force at massless coordinates, rest_.Q, compared with the largest force of all: those of
// inertia too, of the small masses as well (accelerations are -rest_.qdd), since nothing else may act in a
// motion without loads.
double ConstraintSolver::find_massless_residual(std::span<const double> Q, std::span<const double> lambda) {
  double largest = 0, left = 0;
  for (std::size_t c = 0; c < rest_.Q.size(); ++c) {
    double sum = std::abs(Q[c]);
    if (masses_.inverse[c] > 0) sum += std::abs(rest_.qdd[c]) / masses_.inverse[c];
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) {
      sum += std::abs(jacobian_[at(k)] * lambda[at(plan_->jacobian.row_index[at(k)])]);
    }
    largest = std::max(largest, sum * std::sqrt(masses_.inverse[c]));
  }
  for (int c : masses_.massless) {
    const double part = std::abs(rest_.Q[at(c)]) * std::sqrt(masses_.inverse[at(c)]);
    if (part > left) {
      left = part;
      worst_massless_ = c;
    }
  }
  return left > 0 ? left / largest : 0;
}

// Adds the solution for the residual of the true equations: Q - M qdd - Phi_q^T lambda and gamma - Phi_q qdd. One round
// where masses are only unequal; with massless coordinates until nothing is gained any more, and one at least: where no
// force acts on them they are in balance at once, but the small masses have cost the accelerations their digits.
void ConstraintSolver::refine_motion(std::span<const double> Q, std::span<const double> gamma, std::span<double> qdd,
                                     std::span<double> lambda, Counters& counters) {
  double first_change = 0;
  massless_residual_ = 0;
  for (int round = 0;; ++round) {
    for (std::size_t c = 0; c < rest_.Q.size(); ++c) {
      double rest = 0;
      if (masses_.inverse[c] > 0) {
        rest = Q[c] - masses_.given[c] * qdd[c];
        for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) {
          rest -= jacobian_[at(k)] * lambda[at(plan_->jacobian.row_index[at(k)])];
        }
      }
      rest_.Q[c] = rest;
    }
    for (std::size_t c = 0; c < rest_.Q.size(); ++c) rest_.qdd[c] = -qdd[c];
    if (!masses_.massless.empty()) {
      const double before = massless_residual_;
      massless_residual_ = find_massless_residual(Q, lambda);
      const bool shrinks = round == 0 || massless_residual_ < 0.5 * before;
      const bool done = !(massless_residual_ > massless_rounding) || !shrinks || round == most_massless_rounds;
      if (done && round > 0) return;
    }
    std::copy(gamma.begin(), gamma.end(), rest_.gamma.begin());
    multiply_add(rest_.qdd, rest_.gamma);
    add_compliance<double>(lambda, rest_.gamma);
    solve_with_masses<double>(rest_.Q, rest_.gamma, rest_.qdd, rest_.lambda, scratch_, counters);
    // Squares, by masses: metres beside radians.
    double change = 0, whole = 0;
    for (std::size_t c = 0; c < rest_.Q.size(); ++c) {
      change = std::max(change, masses_.given[c] * rest_.qdd[c] * rest_.qdd[c]);
      whole = std::max(whole, masses_.given[c] * qdd[c] * qdd[c]);
      qdd[c] += rest_.qdd[c];
    }
    for (std::size_t k = 0; k < rest_.lambda.size(); ++k) lambda[k] += rest_.lambda[k];
    if (round == 0) first_change = change;
    // Every round reduces its change by the same factor.
    if (masses_.massless.empty() && (round > 2 || !(change * first_change > negligible * negligible * whole * whole)))
      return;
  }
}

std::vector<double> ConstraintSolver::massless_shares(Counters& counters) {
  std::vector<double> shares(masses_.massless.size(), 0.0), loads(masses_.inverse.size()), qdd(loads),
      lambda(at(plan_->rows));
  const std::vector<double> gamma(lambda);
  std::mt19937 random(1);
  for (int probe = 0; probe < most_probes; ++probe) {
    for (int c : masses_.massless) loads[at(c)] = (random() & 1 ? 1 : -1) / std::sqrt(masses_.inverse[at(c)]);
    solve_with_masses<double>(loads, gamma, qdd, lambda, scratch_, counters);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const std::size_t c = at(masses_.massless[k]);
      shares[k] = std::max(shares[k], std::abs(qdd[c]) / std::sqrt(masses_.inverse[c]));
    }
  }
  return shares;
}

}  // namespace catena
