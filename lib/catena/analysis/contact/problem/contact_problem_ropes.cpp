// ContactProblem: ropes and their grips.
#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/problem/contact_problem.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
std::vector<std::size_t> ContactProblem::grips_of(std::size_t head) const {
  std::vector<std::size_t> grips;
  for (std::size_t k = head + 1; k < place.size(); ++k) {
    if (place[k].head == static_cast<int>(head)) grips.push_back(k);
  }
  return grips;
}

double ContactProblem::tension_before(std::size_t grip) const {
  const std::size_t head = static_cast<std::size_t>(place[grip].head);
  double tension = x[2 * head];
  for (std::size_t k = head + 1; k < grip; ++k) {
    if (place[k].head == place[grip].head) tension += x[2 * k + 1];
  }
  return tension;
}

// How far the tensions beside a grip that sticks are beyond its limits; negative: within.
double ContactProblem::misfit(std::size_t grip) const {
  const double before = tension_before(grip), behind = before + x[2 * grip + 1];
  return std::max(behind - before * place[grip].growth, before - behind * place[grip].growth);
}

bool ContactProblem::solve_rope(std::size_t head) {
  const std::vector<std::size_t> grips = grips_of(head);
  const std::vector<double> before = x;
  const std::size_t n = 2 * head;
  const auto open = [&] {
    state[head] = State::open;
    x[n] = 0;
    for (const std::size_t k : grips) {
      state[k] = State::open;
      x[2 * k + 1] = 0;
      direction[k] = 0;
    }
  };
  open();
  if (without_own(head, 0) >= 0 || !(D(n, n) > 0)) return true;
  state[head] = State::slides;
  for (const std::size_t k : grips) {
    direction[k] = place[k].slip;
    state[k] = direction[k] != 0 ? State::slides : State::sticks;
  }
  const std::vector<double> others = x;
  for (std::size_t pass = 0; pass < 8 * grips.size() + 8; ++pass) {
    x = others;
    solve_rope_states(head);
    const auto is_wrong = [&](std::size_t k) {
      const double size = std::abs(tension_before(k)) + std::abs(x[2 * k + 1]);
      if (state[k] == State::sticks) return misfit(k) > thresholds::solved * size;
      if (place[k].slip != 0) return false;
      double slip = b[2 * k + 1], terms = std::abs(slip);
      for (std::size_t c = 0; c < x.size(); ++c) {
        slip += D(2 * k + 1, c) * x[c];
        terms += std::abs(D(2 * k + 1, c) * x[c]);
      }
      return direction[k] * slip < -thresholds::solved * terms;
    };
    const auto wrong = std::find_if(grips.begin(), grips.end(), is_wrong);
    if (wrong == grips.end()) {
      if (!(x[n] >= 0)) return false;
      for (const std::size_t k : grips)
        grip_change_ = std::max(grip_change_, size_of(2 * k + 1, std::abs(x[2 * k + 1] - before[2 * k + 1])));
      return true;
    }
    const bool stuck = state[*wrong] == State::sticks;
    direction[*wrong] = !stuck ? 0 : x[2 * *wrong + 1] > 0 ? -1 : 1;
    state[*wrong] = stuck ? State::slides : State::sticks;
  }
  return false;
}

// What one unit of x_n of a rope's place, or of x_t of a grip that sticks, makes of x at the sliding grips behind it.
void ContactProblem::add_sliding_grips(std::size_t from, std::vector<std::pair<std::size_t, double>>& parts) const {
  const int head = place[from].head < 0 ? static_cast<int>(from) : place[from].head;
  double tension = 1;
  for (std::size_t k = from + 1; k < place.size(); ++k) {
    if (place[k].head != head || state[k] != State::slides) continue;
    const double change = tension * (std::pow(place[k].growth, -direction[k]) - 1);
    parts.emplace_back(2 * k + 1, change);
    tension += change;
  }
}

// A rope and its grips, with the states at hand, x of all others known.
void ContactProblem::solve_rope_states(std::size_t head) {
  std::vector<Unknown> unknowns{{2 * head, {{2 * head, 1.0}}}};
  add_sliding_grips(head, unknowns.back().parts);
  for (const std::size_t k : grips_of(head)) {
    if (state[k] != State::sticks) continue;
    unknowns.push_back({2 * k + 1, {{2 * k + 1, 1.0}}});
    add_sliding_grips(k, unknowns.back().parts);
  }
  const std::vector<double> known = x;
  solve_unknowns(unknowns, known);
}

}  // namespace catena
