#include "catena/analysis/dynamics/dynamics_with_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "catena/analysis/events/engaged_turns.hpp"
#include "catena/analysis/events/engagement.hpp"
#include "catena/analysis/events/first_actions.hpp"
#include "catena/analysis/run/released_elements.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Places that open and close in turns have few sets of equations: two places and their slides eight. Those of large
// mechanisms hardly come again while they are kept, and take some kilobytes a body each.
constexpr std::size_t most_kept = 8;
constexpr int most_kept_bodies = 4096;

}  // namespace

DynamicsWithEvents::DynamicsWithEvents(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                                       const DynamicsOptions& options, std::vector<Event> events,
                                       const ColumnSources& sources, bool ropes)
    : contacts_(model, ropes),
      given_model_(std::move(model)),
      model_(given_model_),
      plan_options_(plan_options),
      options_(options) {
  FirstActions first = first_actions(events, *model_);
  plan_options_.keep_elements.insert(plan_options_.keep_elements.end(), first.acted_on.begin(), first.acted_on.end());
  plan_options_.released_elements.insert(plan_options_.released_elements.end(), first.released.begin(),
                                         first.released.end());
  inactive_ = std::move(first.ambiguous);
  make_dynamics();
  methods_ = {dynamics_->method()};
  watch_ = std::make_unique<EventWatch>(std::move(events), *model_, dynamics_->plan(), sources);
}

// The present one may be wanted again.
void DynamicsWithEvents::keep_dynamics() {
  const bool returns = contacts_.any() && contacts_.started() && !contacts_.changes_structure() && turned_.empty();
  if (!returns) return kept_.clear();
  kept_.push_back({released_, model_, std::move(dynamics_)});
  const int most = most_kept_bodies / std::max<int>(static_cast<int>(model_->bodies.size()), 1);
  const std::size_t most_now = std::clamp<std::size_t>(static_cast<std::size_t>(most), 1, most_kept);
  if (kept_.size() > most_now) kept_.erase(kept_.begin());
}

// Goes on with the equations that held where these elements were released, if they are kept.
bool DynamicsWithEvents::take_up_kept(const std::vector<int>& released) {
  const auto kept = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.released == released; });
  if (kept == kept_.end()) return false;
  Evaluator& evaluator = kept->dynamics->evaluator();
  // Scales of squared distances are those of t = 0, at which a mechanism is made.
  const auto begins_later = [](const TimeFunction<double>& f) { return !f.domain().contains(0); };
  if (std::any_of(model_->functions.begin(), model_->functions.end(), begins_later)) return false;
  evaluator.set_time(0);
  evaluator.set_model(*model_);
  evaluator.counters = {};
  dynamics_ = std::move(kept->dynamics);
  kept_.erase(kept);
  return true;
}

void DynamicsWithEvents::make_dynamics() {
  if (dynamics_ && follower_) follower_->jump();
  if (dynamics_) keep_dynamics();
  model_ = given_model_;
  PlanOptions plan = plan_options_;
  if (contacts_.any()) {
    model_ = contacts_.model();
    contacts_.add_rows(plan);
  }
  if (!turned_.empty()) {
    const auto turned = std::make_shared<Model>(*model_);
    for (std::size_t e = 0; e < turned_.size(); ++e) {
      if (turned_[e] != 0) turn_value(*turned, static_cast<int>(e), turned_[e]);
    }
    model_ = turned;
  }
  std::vector<int> released = plan.released_elements;
  std::sort(released.begin(), released.end());
  if (!take_up_kept(released)) dynamics_ = std::make_unique<Dynamics>(model_, plan, options_);
  released_ = std::move(released);
  if (contacts_.any() && contacts_.started()) contacts_.attach(*dynamics_, *watch_);
}

void DynamicsWithEvents::start_from(const SystemState& state) {
  if (resumed_) return;
  start_ = state;
  held_ = state.held;
  dynamics_->start_from(state);
  turn_values_to_bodies(held_, state);
}

SystemState DynamicsWithEvents::state() const {
  SystemState state = end_ ? *end_ : dynamics_->state();
  state.ropes = contacts_.turns(state);
  // After what events did last, too, and no rows of contacts that are open.
  state.released = released_by_events(*given_model_, plan_options_.released_elements);
  state.held = held_by_events(watch_->events(), plan_options_.released_elements, held_);
  // Slides of contacts are none of the given model's.
  std::erase_if(state.curves,
                [this](const CurvePlace& place) { return at(place.element) >= given_model_->elements.size(); });
  return state;
}

Report DynamicsWithEvents::start_contacts() {
  SystemState state = start_ ? *start_ : SystemState{};
  if (Report started = contacts_.start(state, plan_options_); !started.ok()) return started;
  dynamics_.reset();
  kept_.clear();
  make_dynamics();
  dynamics_->start_from(state);
  MotionPhase first{.t = state.t};
  take_note_of_jump(first);
  tell(std::move(first));
  return {};
}

void DynamicsWithEvents::take_note_of_jump(MotionPhase& next) const {
  if (!witness_ || !contacts_.jump()) return;
  next.jumps.push_back(*contacts_.jump());
  next.jumps.back().released = plan_options_.released_elements;
}

void DynamicsWithEvents::tell(MotionPhase next) const {
  if (!witness_) return;
  next.released = released_;
  if (contacts_.any()) {
    next.states = contacts_.states();
    next.watched = contacts_.watched();
  }
  witness_->begin(next);
}

void DynamicsWithEvents::go_on_from(const SystemState& state, std::span<const int> engaged, bool sum_up_work,
                                    double work_of_jolt, const WorkByDriver& by_driver) {
  WorkSoFar work = dynamics_->work_so_far();
  work.supplied += work_of_jolt;
  work.energy += work_of_jolt;
  for (const auto& [driver, own] : by_driver) {
    if (!work.by_driver.empty()) work.by_driver[static_cast<std::size_t>(driver)] += own;
  }
  const double energy = dynamics_->energy_in_motion();
  std::shared_ptr<const LawStretches> laws = dynamics_->law_stretches();
  const IntegrationMethod method = dynamics_->method();
  make_dynamics();
  dynamics_->begin_with(method);
  dynamics_->start_from(state);
  turn_values_to_bodies(engaged, state);
  dynamics_->know_energy(energy);
  dynamics_->know_law_stretches(std::move(laws));
  if (sum_up_work) dynamics_->carry_on(std::move(work));
}

Report DynamicsWithEvents::change_contacts(int transition, bool sum_up_work) {
  SystemState state = dynamics_->state();
  if (Report changed = contacts_.change(transition, state); !changed.ok()) return changed;
  MotionPhase next{.t = state.t, .ended_by = transition};
  take_note_of_jump(next);
  go_on_from(state, {}, sum_up_work);
  tell(std::move(next));
  return {};
}

Report DynamicsWithEvents::meet_jump(bool sum_up_work) {
  SystemState state = dynamics_->state();
  if (Report met = contacts_.meet_jump(state); !met.ok()) return met;
  jolts_.push_back({state.t, {}, dynamics_->jumping_drivers(), contacts_.take_impulses()});
  const auto by_driver = work_of_drivers(dynamics_->evaluator(), jolts_.back());
  double work = 0;
  for (const auto& [driver, own] : by_driver) work += own;
  MotionPhase next{.t = state.t, .functions_jump = true};
  take_note_of_jump(next);
  go_on_from(state, {}, sum_up_work, work, by_driver);
  tell(std::move(next));
  return {};
}

void DynamicsWithEvents::resume(const MotionMemory& memory) {
  if (contacts_.has_places())
    throw std::invalid_argument("a motion with contacts, stops or dry friction cannot be taken up");
  resumed_ = true;
  first_row_ = memory.next_row;
  rows_before_ = memory.rows_given;
  plan_options_.released_elements = memory.events.released;
  turned_ = memory.events.turned;
  held_ = memory.events.held;
  jolts_ = memory.jolts;
  watch_->remember(memory.events);
  if (contacts_.any()) taken_up_ = resume_ropes(memory);
  make_dynamics();
  dynamics_->resume(memory);
}

Report DynamicsWithEvents::resume_ropes(const MotionMemory& memory) {
  const Evaluator& evaluator = dynamics_->evaluator();
  const Plan& plan = evaluator.plan();
  // Dynamics refuses it.
  if (memory.y.size() < at(plan.coordinates()) || memory.turns.size() != at(plan.moving)) return {};
  std::vector<double> q(memory.y.begin(), memory.y.begin() + plan.coordinates());
  for (std::size_t p = 0; p < memory.turns.size(); ++p) q[3 * p + 2] += 2 * std::numbers::pi * memory.turns[p];
  SystemState state = state_of(evaluator, memory.t, q);
  state.ropes = memory.ropes;
  state.curves = memory.curves;
  std::vector<ContactEvent> events;
  for (const RopeEvent& event : memory.rope_events)
    events.push_back({event.element, event.met != 0 ? met_pulley : left_pulley, event.t});
  return contacts_.resume(state, std::move(events), plan_options_);
}

void DynamicsWithEvents::save_and_resume(std::int64_t rows_given, std::int64_t next_row) {
  MotionMemory memory = dynamics_->memory();
  memory.next_row = next_row;
  memory.rows_given = rows_given;
  memory.events = watch_->memory();
  memory.events.released = plan_options_.released_elements;
  memory.events.turned = turned_;
  memory.events.held = held_;
  memory.jolts = jolts_;
  memory.ropes = contacts_.turns(dynamics_->state());
  memory.rope_events.clear();  // of the pause before
  for (const ContactEvent& event : contacts_.events())
    memory.rope_events.push_back({event.element, event.kind == met_pulley, event.t});
  if (pauses_.save) pauses_.save(memory);
  resume(memory);
}

// The configuration in the present state, at whose time the evaluator is then.
std::vector<double> DynamicsWithEvents::place() {
  Evaluator& evaluator = dynamics_->evaluator();
  evaluator.set_time(dynamics_->time());
  return configuration_of(evaluator, dynamics_->state());
}

// The values of elements that were engaged, now or before the start, moved by the turns that the bodies made without
// them.
void DynamicsWithEvents::turn_values_to_bodies(std::span<const int> engaged, const SystemState& state) {
  bool any = false;
  for (const int element : engaged) {
    const int turns = whole_turns_of(*model_, element, residuals_of(dynamics_->evaluator(), place(), element));
    if (turns == 0) continue;
    any = true;
    turned_.resize(model_->elements.size());
    turned_[static_cast<std::size_t>(element)] += turns;
  }
  if (!any) return;
  make_dynamics();
  dynamics_->start_from(state);
}

Report DynamicsWithEvents::act(int number, SystemState& state, std::vector<int>& engaged, double& work,
                               MotionPhase& next) {
  const Event& event = watch_->events()[static_cast<std::size_t>(number)];
  if (event.action == EventAction::strike) {
    double own = 0;
    if (Report struck = contacts_.strike(event.strike, plan_options_, state, own); !struck.ok()) return struck;
    jolts_.push_back({state.t, event.name, {}, contacts_.take_impulses()});
    take_note_of_jump(next);
    if (!next.jumps.empty()) next.jumps.back().event = number;
    work += own;
    return {};
  }
  std::vector<int>& released = plan_options_.released_elements;
  std::erase(released, event.element);
  std::erase(engaged, event.element);
  (event.action == EventAction::engage ? engaged : released).push_back(event.element);
  if (!contacts_.any()) return {};
  if (Report changed = contacts_.change_constraints(plan_options_, state); !changed.ok()) return changed;
  jolts_.push_back({state.t, event.name, {}, contacts_.take_impulses()});
  take_note_of_jump(next);
  return {};
}

Report DynamicsWithEvents::act(bool sum_up_work, const Event*& stop) {
  SystemState state = dynamics_->state();
  std::vector<int> engaged;
  double work = 0;
  std::string engaging;
  MotionPhase next{.t = state.t};
  for (const int acting : dynamics_->acting()) {
    const Event& event = watch_->events()[static_cast<std::size_t>(acting)];
    if (event.action == EventAction::stop) {
      stop = &event;
      end_ = std::move(state);
      return {};
    }
    if (event.action == EventAction::engage) engaging += (engaging.empty() ? "" : ", ") + event.name;
    next.events.push_back(acting);
    if (Report acted = act(acting, state, engaged, work, next); !acted.ok()) return acted;
  }
  if (!contacts_.any() && !engaged.empty()) {
    next.jumps.push_back({.meets_constraints = true});
    next.jumps.back().released = plan_options_.released_elements;
  }
  go_on_from(state, engaged, sum_up_work, work);
  tell(std::move(next));
  // With contacts these have decided about the jolt already.
  if (!contacts_.any()) dynamics_->expect_jolt(engaging);
  for (const int element : engaged) {
    if (Report fits = check_fit(dynamics_->evaluator(), place(), element); !fits.ok()) return fits;
  }
  return {};
}

// Drivers moved on against closed contacts: the last row is that place, with the rates before.
void DynamicsWithEvents::end_in_lock_up(const Needs& needs, RowObserver& rows) {
  if (!contacts_.any() || !contacts_.blocked()) return;
  singular_points_.push_back(*contacts_.blocked());
  WorkSoFar work = dynamics_->work_so_far();
  dynamics_->watch(nullptr);
  dynamics_->start_from(dynamics_->state());
  if (needs.work) dynamics_->carry_on(std::move(work));
  dynamics_->run(TimeGrid::instant(dynamics_->time()), needs, rows);
}

}  // namespace catena
