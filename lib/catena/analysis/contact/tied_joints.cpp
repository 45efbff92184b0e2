// ContactSwitch: joints that stick although others hold what they hold; same_slides.hpp.
#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/contact/problem/same_slides.hpp"
#include "catena/base/at.hpp"

namespace catena {

void ContactSwitch::tie_joints(const ContactProblem& problem, std::vector<ContactState>& states) const {
  std::vector<std::size_t> rows;  // of what holds
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactProblem::Place& place = problem.place[a];
    if (!place.has_normal || problem.state[a] == ContactProblem::State::open) continue;
    rows.push_back(2 * a);
    if (problem.state[a] == ContactProblem::State::sticks) rows.push_back(2 * a + 1);
  }
  const auto tie = [&](std::size_t a, double part_of_normal, int master, double part_of_master) {
    ContactState& state = states[active_[a]];
    state.tied = true;
    state.master = master;
    state.held = master < 0 ? part_of_normal : part_of_master;
  };
  const auto shares_with_contacts = [&](std::size_t a) {
    return std::any_of(shared_.begin(), shared_.end(), [&](const SharedForces& forces) {
      return std::find(forces.places().begin(), forces.places().end(), active_[a]) != forces.places().end();
    });
  };
  for (const SameSlide& slide : same_slides(problem)) {
    const std::size_t m = slide.places.front();
    if (std::any_of(slide.places.begin(), slide.places.end(), shares_with_contacts)) continue;
    const bool holds = !problem.depends(2 * m + 1, rows);
    if (holds) rows.push_back(2 * m + 1);
    for (std::size_t n = holds ? 1 : 0; n < slide.places.size(); ++n) {
      const std::size_t a = slide.places[n];
      const double limit = problem.place[a].limit, force = problem.x[2 * a + 1];
      const double part = limit > 0 ? std::clamp(force / limit, -1.0, 1.0) : 0;
      const double limit_of_master = problem.place[m].limit;
      // Nothing presses any of them where nothing presses the master.
      const double of_master = limit_of_master > 0 ? std::copysign(limit / limit_of_master, slide.ratios[n]) : 0;
      tie(a, points_[active_[a]].mu_static * part, holds ? static_cast<int>(active_[m]) : -1, of_master);
    }
  }
}

// Whether all joints that stuck go on doing so, below their limits.
bool ContactSwitch::holds_below_limits(const ContactProblem& problem, const std::vector<ContactState>& states) const {
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    if (points_[k].kind != ContactKind::joint || states[k].direction != 0) continue;
    const double most = (1 - ContactProblem::rounding_of_sums) * problem.place[a].limit;
    if (!is_sticking_joint(problem, a) || !(std::abs(problem.x[2 * a + 1]) < most)) return false;
  }
  return true;
}

// Where a joint reaches the limit of its share all go on as they are if another share keeps all limits; else those that
// slide as one with it leave together.
void ContactSwitch::share_or_leave(double t, std::span<const double> qd, const std::vector<ContactState>& states,
                                   const Cause& cause, const ContactLoads& loads, ContactProblem& problem) {
  const auto is_tied = [&](std::size_t k) { return points_[k].kind == ContactKind::joint && states[k].tied; };
  // Of a contact that reaches its limit another share of the joints changes nothing.
  if (cause.leaves == 0 || points_[at(cause.place)].kind != ContactKind::joint ||
      std::none_of(active_.begin(), active_.end(), is_tied))
    return;
  Cause stays = cause;
  stays.leaves = 0;
  ContactProblem shared(active_.size());
  set_up(shared, stays);
  if (press_joints(t, qd, loads, shared).ok() && holds_below_limits(shared, states)) {
    problem = std::move(shared);
    return;
  }
  const auto first = static_cast<std::size_t>(
      std::find(active_.begin(), active_.end(), static_cast<std::size_t>(cause.place)) - active_.begin());
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactPoint& point = points_[active_[a]];
    if (point.kind != ContactKind::joint || states[active_[a]].direction != 0 || !point.is_exact()) continue;
    if (slide_as_one(problem, a, first))
      problem.place[a].slip = problem.D(2 * a + 1, 2 * first + 1) > 0 ? cause.leaves : -cause.leaves;
  }
}

}  // namespace catena
