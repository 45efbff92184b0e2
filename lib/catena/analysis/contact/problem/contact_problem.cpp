#include "catena/analysis/contact/problem/contact_problem.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace catena {
namespace {

// Sweeps over all places. Two places of a body converge within some dozen, a stack of n within some n^2, up to a
// hundred.
constexpr int most_sweeps = 10000;

}  // namespace

double ContactProblem::without_own(std::size_t k, std::size_t along) const {
  const std::size_t row = 2 * k + along;
  double w = b[row];
  for (std::size_t c = 0; c < x.size(); ++c) {
    if (c / 2 != k) w += D(row, c) * x[c];
  }
  return w;
}

// What presses is known: only the friction is to be found.
void ContactProblem::solve_along(std::size_t k, double w_t) {
  const std::size_t t = 2 * k + 1;
  const Place& p = place[k];
  const double stick = D(t, t) > 0 ? -w_t / D(t, t) : 0;
  if (p.slip == 0 && std::abs(stick) <= p.limit && !is_carried(k, w_t)) {
    state[k] = State::sticks;
    x[t] = stick;
    return;
  }
  state[k] = State::slides;
  direction[k] = p.slip != 0 ? p.slip : w_t < 0 ? -1 : 1;
  x[t] = -direction[k] * p.kinetic;
}

bool ContactProblem::solve_place(std::size_t k) {
  const std::size_t n = 2 * k, t = n + 1;
  const Place& p = place[k];
  if (p.head >= 0) return true;  // with its rope
  if (has_grips_ && !grips_of(k).empty()) return solve_rope(k);
  const double w_n = p.has_normal ? without_own(k, 0) : 0, w_t = p.has_friction ? without_own(k, 1) : 0;
  if (!p.has_normal) {
    solve_along(k, w_t);
    return true;
  }
  state[k] = State::open;
  direction[k] = 0;
  x[n] = x[t] = 0;
  // A slip that is there already and wedges: nothing fits, or a free and a pressed place fit alike.
  if (p.has_friction && p.slip != 0 && D(n, n) > 0 && !(D(n, n) - p.mu * p.slip * D(n, t) > 0)) return false;
  // What cannot move is pressed by nothing.
  if (w_n >= 0 || !(D(n, n) > 0)) return true;
  if (!p.has_friction) {
    state[k] = State::slides;
    x[n] = -w_n / D(n, n);
    return true;
  }
  const double determinant = D(n, n) * D(t, t) - D(n, t) * D(t, n);
  if (p.slip == 0 && !is_carried(k, w_t)) {
    // Where nothing resists along the contact there is no slip to stop.
    const bool regular = determinant > 1e-14 * D(n, n) * D(t, t);
    const double press = regular ? (-w_n * D(t, t) + w_t * D(n, t)) / determinant : -w_n / D(n, n);
    const double along = regular ? (-w_t * D(n, n) + w_n * D(t, n)) / determinant : 0;
    // Where the place gives way in one direction alone, as at the end of a crank, a rebound comes with a slip.
    const double slip = w_t + D(t, n) * press;
    const bool stops =
        regular || !(D(t, t) > 0) || std::abs(slip) <= rounding_of_sums * (std::abs(w_t) + std::abs(D(t, n)) * press);
    if (stops && press >= 0 && std::abs(along) <= p.mu_static * press) {
      state[k] = State::sticks;
      x[n] = press;
      x[t] = along;
      return true;
    }
  }
  for (const int s : {1, -1}) {
    if (p.slip != 0 && s != p.slip) continue;
    const double resistance = D(n, n) - p.mu * s * D(n, t);
    if (!(resistance > 0)) continue;
    const double press = -w_n / resistance, slip = w_t + (D(t, n) - p.mu * s * D(t, t)) * press;
    if (p.slip == 0 && slip * s < 0) continue;
    state[k] = State::slides;
    direction[k] = s;
    x[n] = press;
    x[t] = -p.mu * s * press;
    return true;
  }
  return false;
}

// All places at once, with the states found; redundant ones share as the least x does.
void ContactProblem::solve_states() {
  std::vector<double> known(x.size(), 0.0);
  std::vector<Unknown> unknowns;
  for (std::size_t k = 0; k < place.size(); ++k) {
    const std::size_t n = 2 * k, t = n + 1;
    if (state[k] == State::open) continue;
    if (place[k].head >= 0) {
      if (state[k] == State::sticks) {
        unknowns.push_back({t, {{t, 1.0}}});
        add_sliding_grips(k, unknowns.back().parts);
      }
      continue;
    }
    if (!place[k].has_normal) {
      if (state[k] == State::sticks) unknowns.push_back({t, {{t, 1.0}}});
      if (state[k] == State::slides) known[t] = x[t];
      continue;
    }
    unknowns.push_back({n, {{n, 1.0}}});
    if (place[k].has_friction && state[k] == State::slides)
      unknowns.back().parts.emplace_back(t, -place[k].mu * direction[k]);
    add_sliding_grips(k, unknowns.back().parts);
    if (state[k] == State::sticks) unknowns.push_back({t, {{t, 1.0}}});
  }
  solve_unknowns(unknowns, known);
}

// w = 0 in the rows of the unknowns, beside what is known of x.
void ContactProblem::solve_unknowns(const std::vector<Unknown>& unknowns, const std::vector<double>& known) {
  const auto size = static_cast<Eigen::Index>(unknowns.size());
  if (size == 0) return;
  Eigen::MatrixXd matrix(size, size);
  Eigen::VectorXd right(size);
  for (Eigen::Index r = 0; r < size; ++r) {
    const std::size_t row = unknowns[static_cast<std::size_t>(r)].row;
    right(r) = -b[row];
    for (std::size_t c = 0; c < known.size(); ++c) right(r) -= D(row, c) * known[c];
    for (Eigen::Index c = 0; c < size; ++c) {
      matrix(r, c) = 0;
      for (const auto& [part, factor] : unknowns[static_cast<std::size_t>(c)].parts)
        matrix(r, c) += D(row, part) * factor;
    }
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(no_response);
  factors.compute(matrix);
  const Eigen::VectorXd solution = factors.solve(right);
  x = known;
  for (Eigen::Index c = 0; c < size; ++c) {
    for (const auto& [part, factor] : unknowns[static_cast<std::size_t>(c)].parts) x[part] += factor * solution(c);
  }
}

// Over all places until nothing changes. False: friction wedges a place, or sweeps do not settle.
bool ContactProblem::sweep(double& size) {
  for (int round = 0; round <= most_sweeps; ++round) {
    double change = 0;
    size = grip_change_ = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
      const double before[2] = {x[2 * k], x[2 * k + 1]};
      if (!solve_place(k)) return false;
      for (const std::size_t along : {0, 1}) {
        const std::size_t row = 2 * k + along;
        change = std::max(change, size_of(row, std::abs(x[row] - before[along])));
        size = std::max(size, size_of(row, std::abs(x[row])));
      }
    }
    if (!std::isfinite(size)) return false;
    change = std::max(change, grip_change_);
    if (change <= rounding_of_sums * size && change <= rounding()) return true;
  }
  return false;
}

bool ContactProblem::solve() {
  double size = 0;
  find_units();
  has_grips_ = std::any_of(place.begin(), place.end(), [](const Place& p) { return p.head >= 0; });
  if (!preferred_state_.empty() && !is_many()) {
    state = preferred_state_;
    direction = preferred_direction_;
    if (try_states()) return true;
  }
  if (is_many()) {
    if (is_wedged()) return false;
    if (pivot()) return true;
  }
  if (!ruled_out_state_.empty() && search()) return true;
  // What is left to sweeps may come back to what was ruled out: the motion then ends, as contacts that change without
  // end.
  if (!sweep(size)) return search() || (!is_many() && !has_grips_ && !is_wedged() && pivot());
  if (sticks_together() && search()) return true;
  const std::vector<double> swept = x;
  const std::vector<State> states = state;
  // Redundant places first: sweeps leave the later ones of them without a force, though they close as well.
  if (close_redundant(size)) {
    solve_states();
    if (fits(size) || (!has_grips_ && try_states())) return true;
    x = swept;
    state = states;
  }
  solve_states();
  if (!fits(size)) x = swept;
  return true;
}

// Closes open places whose gap does not open either; false: there are none.
bool ContactProblem::close_redundant(double size) {
  bool any = false;
  for (std::size_t k = 0; k < place.size(); ++k) {
    const std::size_t n = 2 * k, t = n + 1;
    if (state[k] != State::open || !place[k].has_normal || !(D(n, n) > 0)) continue;
    if (std::abs(without_own(k, 0)) > rounding_of_sums * D(n, n) * unit(n) * size) continue;
    const double w_t = place[k].has_friction ? without_own(k, 1) : 0;
    const bool rests = place[k].slip == 0 && std::abs(w_t) <= rounding_of_sums * D(t, t) * unit(t) * size;
    state[k] = place[k].has_friction && rests ? State::sticks : State::slides;
    if (place[k].has_friction && !rests) direction[k] = place[k].slip != 0 ? place[k].slip : w_t > 0 ? 1 : -1;
    for (const std::size_t grip : grips_of(k)) {
      direction[grip] = place[grip].slip;
      state[grip] = place[grip].slip != 0 ? State::slides : State::sticks;
    }
    any = true;
  }
  return any;
}

}  // namespace catena
