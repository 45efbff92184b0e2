// ContactSwitch: friction of joints and what presses them, state by state.
//
// What presses a joint while it slides may be enough to hold it, and what presses it while it holds may not: friction
// and reactions that are found in turns then change its state without end. With given states each of their rounds
// leaves a part of the error, about mu, and what they end at is judged once: joints that stick hold no more than they
// can, others begin to slide the way that was meant. The more joints stick, the earlier states are tried.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/contact/problem/same_slides.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

using JointState = ContactProblem::State;

/// A choice by its number: of every joint at rest whether it sticks (0) or slides one way or the other; how many slide.
int take_choice(std::size_t number, ContactProblem& problem) {
  int sliding = 0;
  for (std::size_t a = 0; a < problem.place.size(); ++a) {
    const int slip = problem.place[a].slip;
    const auto digit = slip == 0 ? static_cast<int>(number % 3) : 0;
    if (slip == 0) number /= 3;
    const int way = slip != 0 ? slip : digit == 2 ? -1 : digit;
    problem.state[a] = way == 0 ? JointState::sticks : JointState::slides;
    problem.direction[a] = way;
    sliding += way != 0;
  }
  return sliding;
}

}  // namespace

// What presses joints, from the forces that the problem has; how much it changed, and its size.
ContactSwitch::Pressing ContactSwitch::press(std::span<const double> qd, const ContactLoads& loads,
                                             ContactProblem& problem) const {
  const std::span<const double> free = equations_.multipliers();
  // The multipliers, and the sizes of the terms that they are sums of, for their rounding.
  std::vector<double> lambda(free.size()), terms(free.size());
  for (std::size_t r = 0; r < lambda.size(); ++r) {
    lambda[r] = free[r];
    terms[r] = std::abs(free[r]);
    for (std::size_t c = 0; c < problem.x.size(); ++c) {
      const double part = multipliers_[c][r] * problem.x[c];
      lambda[r] += part;
      terms[r] += std::abs(part);
    }
  }
  Pressing found;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    ContactProblem::Place& place = problem.place[a];
    if (place.has_normal || place.head >= 0) continue;
    const double normal = std::max(loads.normal_from(active_[a], qd, lambda), 0.0);
    const double limit = points_[active_[a]].mu_static * normal;
    found.change = std::max(found.change, std::abs(limit - place.limit));
    found.size = std::max(found.size, points_[active_[a]].mu_static * loads.normal_from(active_[a], qd, terms));
    place.limit = limit;
    place.kinetic = points_[active_[a]].mu * normal;
  }
  return found;
}

bool ContactSwitch::settle_by_states(std::span<const double> qd, const ContactLoads& loads,
                                     ContactProblem& problem) const {
  const auto is_joint = [](const ContactProblem::Place& place) { return !place.has_normal && place.head < 0; };
  if (problem.place.size() > ContactProblem::most_searched ||
      !std::all_of(problem.place.begin(), problem.place.end(), is_joint))
    return false;
  std::size_t count = 1;
  for (const ContactProblem::Place& place : problem.place) count *= place.slip == 0 ? 3 : 1;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  ContactProblem tried = problem;
  std::vector<int> sliding;
  for (const std::size_t number : order) sliding.push_back(take_choice(number, tried));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sliding[a] < sliding[b]; });
  for (const std::size_t number : order) {
    tried = problem;
    take_choice(number, tried);
    Pressing pressing{.change = 1, .size = 0};
    // With given states an error of which a part 0.9 is left in each of them is rounding after a tenth of the rounds.
    LimitShares shares;
    for (int round = 0; round < most_settling / 10 && !pressing.is_settled(); ++round) {
      for (std::size_t a = 0; a < tried.place.size(); ++a) {
        if (tried.state[a] == JointState::slides) tried.x[2 * a + 1] = -tried.direction[a] * tried.place[a].kinetic;
      }
      tried.solve_states();
      shares.share(tried);
      pressing = press(qd, loads, tried);
    }
    if (!pressing.is_settled() || !tried.fits_states()) continue;
    problem = std::move(tried);
    return true;
  }
  return false;
}

}  // namespace catena
