// ContactSwitch: which of the touching places press, stick and slide from now on, by the accelerations of gaps and
// slides without forces there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/contact/problem/same_slides.hpp"
#include "catena/analysis/contact/several_states.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of the speed that forces bring about over the length scale, as the motion's own where it has hardly moved: below
// no_speed of it a rate is rounding of what the forces would make.
constexpr double of_forces = thresholds::few_roundings / no_speed;

}  // namespace

// Accelerations without rigid places and exact friction; compliant ones press as they do.
bool ContactSwitch::find_free_accelerations(double t, std::span<const double> q, std::span<const double> qd,
                                            ContactLoads& loads) {
  equations_.attach(&loads);
  const bool found = equations_.accelerations(t, Side::after, q, qd, unit_.qdd);
  equations_.attach(nullptr);
  return found;
}

// What presses a joint depends on the forces themselves: both are found in turns, from the forces that the problem has.
Report ContactSwitch::press_joints(double t, std::span<const double> qd, const ContactLoads& loads,
                                   ContactProblem& problem) {
  LimitShares shares;
  for (int round = 0; round < most_settling; ++round) {
    const Pressing pressing = press(qd, loads, problem);
    if (!problem.solve()) return wedged(t);
    shares.share(problem);
    if (pressing.is_settled()) return {};
  }
  if (settle_by_states(qd, loads, problem)) return {};
  return failure(t, fmt::format("the friction of {} and the reactions that press there do not settle within {} rounds: "
                                "friction that presses its own joint by more than itself leaves no force that fits, or "
                                "several (Painleve)",
                                names_of(*model_, points_, active_), most_settling));
}

// Which places press, stick and slide from now on.
Report ContactSwitch::choose(double t, std::span<const double> q, std::span<const double> qd,
                             std::vector<ContactState>& states, const Cause& cause) {
  std::vector<ContactState> forces = states;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    if (points_[k].is_elastic_grip()) continue;
    if (points_[k].kind != ContactKind::compliant) forces[k].closed = false;
    if (points_[k].is_exact()) forces[k].direction = 0;
  }
  ContactLoads loads(evaluator_, points_, forces);
  if (!find_free_accelerations(t, q, qd, loads))
    return failure(t, loads.trouble().empty() ? "accelerations are not finite" : loads.trouble());
  sizes_.take(sizes_of_motion(evaluator_.length_scale(), qd, equations_.applied_forces(), equations_.masses().mass));
  know_speed(of_forces * sizes_.speed);
  forget_shared();
  let_leave(t, states, cause);
  for (std::vector<std::size_t>& group : active_by_group()) {
    active_ = std::move(group);
    if (Report chosen = choose_among(t, qd, states, cause, loads); !chosen.ok()) return chosen;
  }
  return {};
}

// Places whose gaps open already, or that nothing presses any more: now, or just before at this instant, where others
// changed since. Those would close again without a force, and take turns without end.
void ContactSwitch::let_leave(double t, std::vector<ContactState>& states, const Cause& cause) {
  std::erase_if(active_, [&](std::size_t k) {
    const bool opens = cause.opens && static_cast<int>(k) == cause.place;
    const double speed = part_of_speed(k, no_speed);
    const bool rigid = points_[k].kind == ContactKind::rigid;
    const bool leaves = rigid && !returns(t, k, cause) && gap_[k].rate > speed;
    const bool has_left = rigid && !states[k].closed && static_cast<int>(k) != cause.place && past_.left_at[k] == t &&
                          gap_[k].rate >= -speed;
    if (!opens && !leaves && !has_left) return false;
    states[k] = {};
    past_.left_at[k] = t;
    return true;
  });
  let_grips_go(states);
}

// Mechanisms that constraints tie, and those that a gap or a slide ties as well.
void ContactSwitch::find_groups() {
  const Plan& plan = evaluator_.plan();
  std::vector<int> leader(at(plan.islands));
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int island) {
    while (leader[at(island)] != island) island = leader[at(island)] = leader[at(leader[at(island)])];
    return island;
  };
  std::vector<int> first(points_.size(), -1);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const auto tie = [&](int body) {
      if (body < 0 || body >= plan.moving) return;
      const int island = find(plan.island[at(body)]);
      if (first[k] < 0) first[k] = island;
      leader[at(island)] = find(first[k]);
    };
    for (const Evaluator::ScalarMotion* motion : {&gap_[k], &slide_[k]}) {
      tie(motion->body_i);
      tie(motion->body_j);
      for (const Evaluator::ScalarMotion::Part& part : motion->parts) {
        tie(part.body_i);
        tie(part.body_j);
      }
    }
  }
  group_.clear();
  for (const int island : first) group_.push_back(island < 0 ? -1 : find(island));
}

// Forces of one mechanism do not reach another.
std::vector<std::vector<std::size_t>> ContactSwitch::active_by_group() {
  if (group_.empty()) find_groups();
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t k : active_) {
    const auto same = [&](const std::vector<std::size_t>& group) { return group_[group.front()] == group_[k]; };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end())
      groups.push_back({k});
    else
      found->push_back(k);
  }
  return groups;
}

// Accelerations of gaps and slides without forces there.
void ContactSwitch::set_up(ContactProblem& problem, const Cause& cause) const {
  fill(problem);
  const auto take = [&](std::size_t row, const Evaluator::ScalarMotion& motion) {
    problem.b[row] = motion.bend + product(motion, unit_.qdd);
    problem.b_terms[row] = std::abs(motion.bend) + size_of_product(motion, unit_.qdd);
  };
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    ContactProblem::Place& place = problem.place[a];
    if (place.has_normal) take(2 * a, gap_[k]);
    if (!points_[k].has_friction()) continue;
    take(2 * a + 1, slide_[k]);
    place.slip = direction_of(slide_[k].rate, part_of_speed(k, no_speed));
    if (static_cast<int>(k) == cause.place && cause.rests) place.slip = cause.leaves;
  }
}

// Places that hold each other go on as they are but for those that give way; as they all are they cannot.
void ContactSwitch::prefer_giving_way(ContactProblem& problem, const std::vector<ContactState>& states,
                                      const Cause& cause) const {
  using State = ContactProblem::State;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactState& state = states[active_[a]];
    const bool sticks = points_[active_[a]].has_friction() && state.direction == 0;
    problem.state[a] = !state.closed ? State::open : sticks ? State::sticks : State::slides;
    problem.direction[a] = state.direction;
  }
  problem.rule_out_states();
  for (const GivesWay& place : cause.giving_way) {
    const auto a = static_cast<std::size_t>(std::find(active_.begin(), active_.end(), place.point) - active_.begin());
    if (a == active_.size()) continue;
    problem.state[a] = place.direction == 0 ? State::open : State::slides;
    problem.direction[a] = place.direction;
  }
  if (!cause.giving_way.empty()) problem.prefer_states();
}

// Of the active places, which are of one mechanism.
Report ContactSwitch::choose_among(double t, std::span<const double> qd, std::vector<ContactState>& states,
                                   const Cause& cause, const ContactLoads& loads) {
  find_responses();
  ContactProblem problem(active_.size());
  set_up(problem, cause);
  if (cause.shares) prefer_giving_way(problem, states, cause);
  share_or_leave(t, qd, states, cause, loads, problem);
  if (Report pressed = press_joints(t, qd, loads, problem); !pressed.ok())
    return is_jammed(true) ? blocked(t, active_) : pressed;
  if (!cause.shares) stick_where_possible(problem);
  if (!cause.shares) stick_where_pressed(t, qd, loads, problem);
  if (const std::vector<std::size_t> pushed = pushed_through(t, problem, cause); !pushed.empty())
    return blocked(t, pushed);
  if (!cause.shares) note_other_states(t, problem);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    const bool grip = points_[k].kind == ContactKind::grip;
    const bool joint = points_[k].kind != ContactKind::rigid && !grip;
    if (!joint) states[k].closed = problem.state[a] != ContactProblem::State::open;
    states[k].direction = problem.state[a] == ContactProblem::State::slides ? problem.direction[a] : 0;
    states[k].tied = false;
    states[k].master = -1;
  }
  SharedForces forces(problem, active_);
  if (!forces.places().empty()) shared_.push_back(std::move(forces));
  tie_grips(problem, states);
  tie_joints(problem, states);
  return {};
}

// What was known of the places that are decided about now.
void ContactSwitch::forget_shared() {
  const auto is_touched = [&](std::size_t k) { return std::find(active_.begin(), active_.end(), k) != active_.end(); };
  std::erase_if(shared_, [&](const SharedForces& forces) {
    return std::any_of(forces.places().begin(), forces.places().end(), is_touched);
  });
}

}  // namespace catena
