#include "catena/analysis/dynamics/contact_phases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/motion/initial_velocities.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

/// An exact place of friction that does not slide holds by the row of its slide.
bool sticks(const ContactPoint& point, const ContactState& state) {
  return !point.is_elastic_grip() && point.has_friction() && point.is_exact() && state.closed && state.direction == 0 &&
         !state.tied;
}

/// Calls f with the constant of a slide's equation, and the sign of the equation's value in it: of a grip that is its
/// length.
template <class M, class F>
void with_slide_value(M& model, int slide, F&& f) {
  const ElementRecord& record = model.elements[at(slide)];
  with_list(model.constraints, record.type, [&](auto& list) {
    using E = ElementOf<decltype(list)>;
    if constexpr (E::functions == 1) f(list[at(record.index)].values[0].constant, 1);
    if constexpr (HasParts<E>) f(list[at(record.index)].element.length, -1);
  });
}

}  // namespace

ContactPhases::ContactPhases(std::shared_ptr<const Model> model, bool ropes)
    : contacts_(contact_points(std::move(model))), first_(contacts_.model) {
  if (ropes) ropes_.emplace(*contacts_.model);
  states_.resize(contacts_.points.size());
  anchors_.assign(contacts_.points.size(), 0.0);
}

void ContactPhases::add_rows(PlanOptions& options, const std::vector<ContactState>& states) const {
  options.one_sided = options.friction = true;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const ContactPoint& point = contacts_.points[k];
    options.keep_elements.push_back(point.kind == ContactKind::joint ? point.joint : point.element);
    if (point.has_friction() && point.slide >= 0) options.keep_elements.push_back(point.slide);
    if (point.kind == ContactKind::grip) {
      if (!sticks(point, states[k]) && point.slide >= 0) options.released_elements.push_back(point.slide);
      if (point.rope->whole >= 0) options.released_elements.push_back(point.rope->whole);
      continue;
    }
    const bool row = point.kind == ContactKind::rigid && states[k].closed;
    if (point.kind != ContactKind::joint && !row) options.released_elements.push_back(point.element);
    if (point.has_friction() && !sticks(point, states[k])) options.released_elements.push_back(point.slide);
  }
}

std::shared_ptr<const Model> ContactPhases::model() const {
  std::shared_ptr<Model> changed;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (!sticks(contacts_.points[k], states_[k])) continue;
    if (!changed) changed = std::make_shared<Model>(*contacts_.model);
    with_slide_value(*changed, contacts_.points[k].slide, [&](double& constant, int) { constant = anchors_[k]; });
  }
  return changed ? std::shared_ptr<const Model>(changed) : contacts_.model;
}

Report ContactPhases::check_depth(std::span<const double> q) {
  Report report;
  Evaluator& evaluator = switch_->evaluator();
  evaluator.set_configuration(q);
  for (const ContactPoint& point : contacts_.points) {
    if (point.kind != ContactKind::rigid) continue;
    const double gap = evaluator.measure(point.element, {}, {}).value;
    if (gap >= -thresholds::given_depth * (point.turns ? 1 : evaluator.length_scale())) continue;
    report.status = Status::inconsistent;
    if (const std::string_view type = contacts_.model->element_type(point.element); type == "rope" || type == "cable") {
      report.message = fmt::format(
          "{} \"{}\" is shorter than its way at the start, by {:.4g} m: make it longer, move its ends, or give it a "
          "stiffness k",
          type, contacts_.model->element_name(point.element), -gap);
      return report;
    }
    report.message = fmt::format(
        "{} \"{}\" is violated at the start by {:.4g} {}: place the bodies so that they do not penetrate, or give it a "
        "stiffness k",
        contacts_.model->element_type(point.element), contacts_.model->element_name(point.element), -gap,
        point.turns ? "rad" : "m");
    return report;
  }
  return report;
}

// Makes the switch anew, for a plan in which no row of a contact holds.
void ContactPhases::make_switch(const PlanOptions& options) {
  options_ = options;
  PlanOptions open = options;
  add_rows(open, std::vector<ContactState>(states_.size()));
  switch_ = std::make_unique<ContactSwitch>(contacts_.model, contacts_.points, open);
}

Report ContactPhases::start(SystemState& state, const PlanOptions& options) {
  states_.assign(contacts_.points.size(), {});
  events_.clear();
  make_switch(options);
  std::vector<double> q = configuration_of(switch_->evaluator(), state);
  switch_->evaluator().set_time(state.t);
  if (const AssemblyOutcome assembled = Assembler(switch_->evaluator()).assemble(q); !assembled.ok()) return assembled;
  if (ropes_ && ropes_->any()) {
    switch_->evaluator().set_configuration(q);
    if (Report found = ropes_->start(state, switch_->evaluator(), contacts_.model); !found.ok()) return found;
    lay_grips(switch_->evaluator());
    const SystemState assembled = state_of(switch_->evaluator(), state.t, q);
    make_switch(options);
    q = configuration_of(switch_->evaluator(), assembled);
    switch_->evaluator().set_time(state.t);
  }
  Evaluator& evaluator = switch_->evaluator();
  if (Report prepared = switch_->prepare(q); !prepared.ok()) return prepared;
  std::vector<double> qd(q.size(), 0.0);
  if (Report depth = check_depth(q); !depth.ok()) return depth;
  const VelocityOutcome velocities =
      find_initial_velocities(switch_->equations(), q, velocities_of(evaluator, state), qd);
  if (!velocities.ok()) return velocities;
  state = state_of(evaluator, state.t, q, qd);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const ContactPoint& point = contacts_.points[k];
    if (point.kind == ContactKind::joint) states_[k].closed = true;
    if (point.kind == ContactKind::compliant) {
      evaluator.set_configuration(q);
      states_[k].closed = evaluator.measure(point.element, {}, {}).value < 0;
    }
  }
  start_elastic(evaluator);
  return decide(state, {.tell = false});
}

Report ContactPhases::resume(const SystemState& state, std::vector<ContactEvent> events, const PlanOptions& options) {
  events_ = std::move(events);
  make_switch(options);
  const std::vector<double> q = configuration_of(switch_->evaluator(), state);
  switch_->evaluator().set_time(state.t);
  switch_->evaluator().set_configuration(q);
  if (Report found = ropes_->start(state, switch_->evaluator(), contacts_.model); !found.ok()) return found;
  if (!first_taken_up_) first_taken_up_ = contacts_.model;
  make_switch(options);
  switch_->evaluator().set_time(state.t);
  return switch_->prepare(q);
}

// For other constraints than before, with what the earlier one knew.
Report ContactPhases::renew_switch(const PlanOptions& options, const SystemState& state) {
  const std::unique_ptr<ContactSwitch> earlier = std::move(switch_);
  make_switch(options);
  if (earlier) switch_->take_over(*earlier);
  Evaluator& evaluator = switch_->evaluator();
  const std::vector<double> q = configuration_of(evaluator, state);
  evaluator.set_time(state.t);
  return switch_->prepare(q);
}

Report ContactPhases::change_constraints(const PlanOptions& options, SystemState& state) {
  if (Report renewed = renew_switch(options, state); !renewed.ok()) return renewed;
  return decide(state, {.jolts = true});
}

Report ContactPhases::strike(const Strike& strike, const PlanOptions& options, SystemState& state, double& work) {
  if (Report renewed = renew_switch(options, state); !renewed.ok()) return renewed;
  Report decided = decide(state, {.strike = &strike});
  work = switch_->work_of_strike();
  return decided;
}

// Whether a place that closes is further from its equation than rounding while friction sticks: a landing is taken at
// the end of ever smaller bounces.
bool ContactPhases::misses_closed() const {
  const Evaluator& evaluator = switch_->evaluator();
  bool any_sticks = false, misses = false;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const ContactPoint& point = contacts_.points[k];
    any_sticks |= sticks(point, states_[k]);
    if (point.kind != ContactKind::rigid || !states_[k].closed) continue;
    const double unit = point.turns ? 1 : evaluator.length_scale();
    misses |= std::abs(evaluator.measure(point.element, {}, {}).value) > thresholds::carried_rounding * unit;
  }
  return any_sticks && misses;
}

// Moves the state to where closed places are, so that what sticks does so there: friction of a pin and a stop of its
// angle hold the same coordinate, and may not ask for two values of it. Where closed places do not fit each other it
// stays: that is said when the next phase begins.
void ContactPhases::meet_closed(SystemState& state) const {
  std::vector<ContactState> closed = states_;
  for (std::size_t k = 0; k < closed.size(); ++k) {
    if (sticks(contacts_.points[k], closed[k])) closed[k].direction = 1;
  }
  PlanOptions options = options_;
  add_rows(options, closed);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*contacts_.model, options), *contacts_.model, work);
  evaluator.set_time(state.t);
  std::vector<double> q = configuration_of(evaluator, state);
  if (Assembler(evaluator).assemble(q).ok()) state = state_of(evaluator, state.t, q, velocities_of(evaluator, state));
}

Report ContactPhases::decide(SystemState& state, const ContactSwitch::Cause& cause) {
  Evaluator& evaluator = switch_->evaluator();
  std::vector<double> q = configuration_of(evaluator, state);
  std::vector<double> qd = velocities_of(evaluator, state);
  qd.resize(q.size(), 0.0);
  if (loads_) switch_->know_speed(loads_->speed());
  Report report = switch_->decide(state.t, q, qd, states_, cause);
  for (ContactEvent& event : switch_->take_events()) events_.push_back(event);
  if (!report.ok()) return report;
  if (misses_closed()) {
    SystemState met = state_of(evaluator, state.t, q, qd);
    meet_closed(met);
    q = configuration_of(evaluator, met);
    evaluator.set_configuration(q);
  }
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const int slide = contacts_.points[k].slide;
    if (!sticks(contacts_.points[k], states_[k])) continue;
    with_slide_value(*contacts_.model, slide, [&](double constant, int sign) {
      anchors_[k] = sign * evaluator.scalar_motion(slide, {}).value + constant;
    });
  }
  settle_elastic(evaluator, qd, cause, state.t);
  state = state_of(evaluator, state.t, q, qd);
  return report;
}

Report ContactPhases::change(int transition, SystemState& state) {
  if (at(transition) >= watched_.size()) return change_way(at(transition) - watched_.size(), state);
  const WatchedPlace& watched = watched_[at(transition)];
  if (contacts_.points[watched.place].is_elastic_grip()) return change_elastic(watched, state);
  if (watched.ends == PhaseEnd::pressing) {
    // A compliant place is pressed by a force that its own depth decides about.
    ContactState& place = states_[watched.place];
    place.closed = !place.closed;
    place.direction = 0;
    events_.push_back({contacts_.points[watched.place].element, place.closed ? "contact" : "release", state.t});
  }
  ContactSwitch::Cause cause{.place = static_cast<int>(watched.place),
                             .rests = watched.ends == PhaseEnd::slide,
                             .shares = watched.ends == PhaseEnd::shares};
  if (cause.shares) {
    const auto normal = [this](std::size_t k) { return loads_->normal(k); };
    const auto along = [this](std::size_t k) { return loads_->friction(k); };
    for (SharedForces& forces : switch_->shared()) {
      if (forces.places().front() == watched.place) cause.giving_way = forces.giving_way(normal, along);
    }
  }
  cause.opens = watched.ends == PhaseEnd::contact && states_[watched.place].closed;
  // What stuck goes the way that friction no longer prevents; by rounding alone the limit might seem not to be reached.
  if (cause.rests && states_[watched.place].direction == 0) cause.leaves = loads_->friction(watched.place) > 0 ? -1 : 1;
  return decide(state, cause);
}

std::string ContactPhases::remark_on_impacts() const {
  if (!switch_) return {};
  const ContactSwitch::OtherLaws& laws = switch_->other_laws();
  if (laws.poisson + laws.reduced == 0) return {};
  std::string what;
  if (laws.poisson > 0) what = fmt::format("in {} Poisson's law took its place", laws.poisson);
  if (laws.reduced > 0)
    what += fmt::format("{}in {} every restitution was reduced until energy does not grow", what.empty() ? "" : ", ",
                        laws.reduced);
  return fmt::format(
      "impacts in which Newton's restitution would have made the kinetic energy grow ({}); the first, of \"{}\", at t "
      "= "
      "{:.9g} s",
      what, contacts_.model->element_name(laws.element), laws.first);
}

std::string ContactPhases::remark_on_states() const {
  if (!switch_ || switch_->several_states().times == 0) return {};
  const ContactSwitch::SeveralStates& several = switch_->several_states();
  return fmt::format(
      "at t = {:.9g} s{} friction leaves open what moves, as it is larger at rest (mu_static) than in motion (mu), or "
      "presses its own joint; taken: {}. Both meet all equations; give equal coefficients, less friction, or let the "
      "load grow from where all is at rest",
      several.first, several.times > 1 ? fmt::format(" and {} times later", several.times - 1) : "", several.states);
}

bool ContactPhases::shares(std::size_t k) const {
  return std::any_of(switch_->shared().begin(), switch_->shared().end(), [k](const SharedForces& forces) {
    return std::find(forces.places().begin(), forces.places().end(), k) != forces.places().end();
  });
}

void ContactPhases::add_shared_transitions(const Dynamics& dynamics, std::vector<Transition>& transitions,
                                           Needs& needs) {
  for (const SharedForces& forces : switch_->shared()) {
    const auto margin = [this, own = forces, &plan = dynamics.plan()](const Snapshot& s) mutable {
      const auto normal = [&](std::size_t k) { return loads_->normal_from(k, s.qd, s.lambda); };
      const auto along = [&](std::size_t k) { return -s.lambda[at(plan.element_row[at(contacts_.points[k].slide)])]; };
      return own.margin(normal, along);
    };
    transitions.push_back({margin, 1});
    watched_.push_back({forces.places().front(), PhaseEnd::shares});
    needs.multipliers = true;
  }
}

void ContactPhases::add_transitions(std::size_t k, const Dynamics& dynamics, std::vector<Transition>& transitions,
                                    Needs& needs) {
  const ContactPoint& point = contacts_.points[k];
  const ContactState state = states_[k];
  const auto watch = [&](std::function<double(const Snapshot&)> value, int side, PhaseEnd ends) {
    transitions.push_back({std::move(value), side});
    watched_.push_back({k, ends});
  };
  if (point.kind == ContactKind::grip) return add_grip_transitions(k, dynamics, transitions, needs);
  const ContactLoads& loads = *loads_;
  const MotionSizes& sizes = switch_->sizes();
  const int element = point.element, slide = point.slide;
  const auto normal = [&loads, k](const Snapshot& s) { return loads.normal_from(k, s.qd, s.lambda); };
  if (point.kind == ContactKind::rigid && !state.closed) {
    // A place that touches, to rounding, and lifts from there may begin a little below zero.
    const double start = std::min(switch_->evaluator().measure(element, {}, {}).value, 0.0);
    watch([element, start](const Snapshot& s) { return s.evaluator.measure(element, {}, {}).value - start; }, 1,
          PhaseEnd::contact);
  }
  if (point.kind == ContactKind::rigid && state.closed) {
    if (!shares(k)) watch(normal, 1, PhaseEnd::contact);
    needs.multipliers = true;
  }
  if (point.kind == ContactKind::compliant && state.closed) watch(normal, 1, PhaseEnd::pressing);
  if (point.kind == ContactKind::compliant && !state.closed) {
    const double depth = point.turns ? 1 : sizes.length, force = sizes.force * (point.turns ? sizes.length : 1);
    watch(
        [element, normal, depth, force](const Snapshot& s) {
          const double reached = -s.evaluator.measure(element, {}, {}).value / depth;
          return force > 0 ? std::min(reached, normal(s) / force) : reached;
        },
        -1, PhaseEnd::pressing);
  }
  if (!point.has_friction() || !point.is_exact() || !state.closed) return;
  needs.multipliers = true;
  if (state.tied && state.master < 0) return;  // a part of what presses, below its limit
  if (state.tied) {
    const int row = dynamics.plan().element_row[at(contacts_.points[at(state.master)].slide)];
    watch([normal, row, mu = point.mu_static,
           held = state.held](const Snapshot& s) { return mu * normal(s) - std::abs(held * s.lambda[at(row)]); },
          1, PhaseEnd::slide);
  } else if (state.direction != 0) {
    watch([slide,
           sign = state.direction](const Snapshot& s) { return sign * s.evaluator.scalar_motion(slide, s.qd).rate; },
          1, PhaseEnd::slide);
  } else if (!shares(k)) {
    const int row = dynamics.plan().element_row[at(slide)];
    watch(
        [normal, row, mu = point.mu_static](const Snapshot& s) { return mu * normal(s) - std::abs(s.lambda[at(row)]); },
        1, PhaseEnd::slide);
  }
}

// What rounding of a watched value is measured against. Slips are differences of speeds of the motion, which may be
// much larger: so may be their rounding.
double ContactPhases::scale_of(const WatchedPlace& watched) const {
  const ContactPoint& point = contacts_.points[watched.place];
  const ContactState& state = states_[watched.place];
  const MotionSizes& sizes = switch_->sizes();
  const double length = sizes.length, force = sizes.force * (point.turns ? length : 1);
  double largest = 0, size = force;
  if (watched.ends == PhaseEnd::stretch) size = length;
  if (watched.ends == PhaseEnd::contact && !state.closed) size = point.turns ? 1 : length;
  // A compliant place that is open, in parts of the sizes; exponents of grips.
  if ((watched.ends == PhaseEnd::pressing && !state.closed) ||
      (watched.ends == PhaseEnd::slide && state.tied && point.kind == ContactKind::grip))
    size = 1;
  if (watched.ends == PhaseEnd::slide && state.direction != 0) {
    largest = rate_of_speed(point, switch_->speed(), length);
    size = rate_of_speed(point, sizes.speed, length);
  }
  return std::max(largest, MotionSizes::least_part * size);
}

void ContactPhases::attach(Dynamics& dynamics, EventWatch& watch) {
  if (loads_) switch_->know_speed(loads_->speed());
  const double speed = switch_->speed();
  loads_ = std::make_unique<ContactLoads>(dynamics.evaluator(), contacts_.points, states_);
  loads_->know_speed(speed);
  dynamics.attach(loads_.get());
  std::vector<Transition> transitions;
  watched_.clear();
  Needs needs{.velocity = true};
  for (std::size_t k = 0; k < states_.size(); ++k) add_transitions(k, dynamics, transitions, needs);
  add_shared_transitions(dynamics, transitions, needs);
  for (std::size_t n = 0; n < watched_.size(); ++n) transitions[n].scale = scale_of(watched_[n]);
  if (ropes_) ropes_->add_transitions(transitions, dynamics.evaluator().length_scale());
  watch.watch(std::move(transitions), needs);
}

}  // namespace catena
