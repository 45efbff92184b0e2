// ContactPhases: ropes that meet and leave pulleys, and their friction there.
#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/elastic_grips.hpp"
#include "catena/analysis/dynamics/contact_phases.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of the exponent that a grip uses up which others keep from slipping, it may be at its limit: that of angles.
constexpr double tied_rounding = 1e-9;

}  // namespace

// The grips of ropes as these lie at the evaluator's configuration.
void ContactPhases::lay_grips(const Evaluator& evaluator) {
  catena::lay_grips(contacts_, ropes_->routes(), [&](const RopeRoute& route) { return frames_of(evaluator, route); });
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const ContactPoint& point = contacts_.points[k];
    if (point.kind == ContactKind::grip && !point.is_elastic_grip() && !point.has_friction()) states_[k] = {};
  }
}

// All tensions of a rope are alike.
void ContactPhases::start_elastic(const Evaluator& evaluator) {
  for (std::size_t r = 0; r < contacts_.ropes.size(); ++r) {
    if (!contacts_.ropes[r].elastic) continue;
    RopePlaces& places = *contacts_.places[r];
    const RopeRoute route = (ropes_ ? ropes_->routes() : rope_routes(*contacts_.model))[at(contacts_.ropes[r].route)];
    places.length = length_behind(*contacts_.model, route, 0, frames_of(evaluator, route));
    places.yields = part_yields(*contacts_.model, contacts_.ropes[r], route, frames_of(evaluator, route));
    for (const std::size_t k : places.grips) states_[k] = {};
    ElasticGrips grips(contacts_.points, contacts_.places[r]);
    grips.look(evaluator, {}, states_);
    const double tension = places.k * std::max(grips.stretch(), 0.0);
    double behind = 0;
    for (std::size_t n = places.grips.size(); n-- > 0;) {
      behind += places.yields[n + 1] * tension;
      states_[places.grips[n]] = {.closed = tension > 0, .held = behind + grips.place(n)};
    }
  }
}

// What grips of elastic ropes do from now on, at velocities that may have jumped.
void ContactPhases::settle_elastic(const Evaluator& evaluator, std::span<const double> qd,
                                   const ContactSwitch::Cause& cause, double t) {
  for (std::size_t r = 0; r < contacts_.ropes.size(); ++r) {
    if (!contacts_.ropes[r].elastic) continue;
    const RopePlaces& places = *contacts_.places[r];
    if (!states_[places.grips.front()].closed) continue;
    const std::vector<ContactState> before = states_;
    ElasticGrips(contacts_.points, contacts_.places[r]).settle(evaluator, qd, states_);
    for (const std::size_t k : places.grips) {
      if (!cause.tell || (before[k].direction == 0) == (states_[k].direction == 0)) continue;
      events_.push_back({contacts_.points[k].element, states_[k].direction == 0 ? "stick" : "slip", t});
    }
  }
}

// A rope lies otherwise now: nothing has passed over its grips. One that it met just now slides, at first without
// friction.
void ContactPhases::keep_stretches(const Evaluator& evaluator, const std::vector<double>& stretch_behind,
                                   const std::vector<char>& touched, std::span<const double> qd) {
  for (std::size_t r = 0; r < contacts_.ropes.size(); ++r) {
    if (!contacts_.ropes[r].elastic) continue;
    const std::vector<std::size_t>& places = contacts_.places[r]->grips;
    ElasticGrips grips(contacts_.points, contacts_.places[r]);
    for (const std::size_t k : places) {
      if (!contacts_.points[k].has_friction()) states_[k].direction = 0;
      if (contacts_.points[k].has_friction() && !touched[k]) states_[k].direction = 1;
    }
    grips.look(evaluator, qd, states_);
    for (std::size_t n = 0; n < places.size(); ++n) {
      ContactState& state = states_[places[n]];
      state.held = stretch_behind[places[n]] + grips.place(n);
      if (contacts_.points[places[n]].has_friction() && !touched[places[n]] && grips.slip(n) < 0) state.direction = -1;
    }
  }
}

// A grip of an elastic rope begins or ends to slide, or the rope comes under tension or loses it.
Report ContactPhases::change_elastic(const WatchedPlace& watched, SystemState& state) {
  Evaluator& evaluator = switch_->evaluator();
  evaluator.set_time(state.t);
  evaluator.set_configuration(configuration_of(evaluator, state));
  const std::shared_ptr<const RopePlaces>& rope = contacts_.points[watched.place].rope;
  ElasticGrips grips(contacts_.points, rope);
  grips.look(evaluator, velocities_of(evaluator, state), states_);
  if (watched.ends == PhaseEnd::stretch) {
    const bool closed = !states_[watched.place].closed;
    for (std::size_t n = 0; n < rope->grips.size(); ++n)
      states_[rope->grips[n]] = {.closed = closed, .held = grips.place(n)};
    return decide(state, {});
  }
  ContactState& changed = states_[watched.place];
  const auto n =
      static_cast<std::size_t>(std::find(rope->grips.begin(), rope->grips.end(), watched.place) - rope->grips.begin());
  if (changed.direction == 0) {
    changed.direction = grips.friction(n) > 0 ? -1 : 1;
  } else {
    changed = {.closed = true, .held = grips.held(n)};
  }
  events_.push_back({contacts_.points[watched.place].element, changed.direction == 0 ? "stick" : "slip", state.t});
  return decide(state, {});
}

// Velocities meet the other way of a rope as well as this one; accelerations, and what presses, may differ.
Report ContactPhases::change_way(std::size_t transition, SystemState& state) {
  Evaluator& evaluator = switch_->evaluator();
  evaluator.set_time(state.t);
  evaluator.set_configuration(configuration_of(evaluator, state));
  std::vector<double> stretch_behind(states_.size(), 0.0);
  std::vector<char> touched(states_.size(), 0);
  for (const auto& rope : contacts_.places) {
    if (rope->whole < 0) continue;
    ElasticGrips grips(contacts_.points, rope);
    grips.look(evaluator, {}, states_);
    for (std::size_t n = 0; n < rope->grips.size(); ++n) {
      stretch_behind[rope->grips[n]] = grips.stretch_behind(n);
      touched[rope->grips[n]] = contacts_.points[rope->grips[n]].has_friction();
    }
  }
  if (Report changed = ropes_->change(transition, evaluator, contacts_.model); !changed.ok()) return changed;
  for (ContactEvent& event : ropes_->take_events()) events_.push_back(event);
  lay_grips(evaluator);
  if (Report renewed = renew_switch(PlanOptions(options_), state); !renewed.ok()) return renewed;
  if (!contacts_.ropes.empty()) {
    Evaluator& now = switch_->evaluator();
    now.set_configuration(configuration_of(now, state));
    keep_stretches(now, stretch_behind, touched, velocities_of(now, state));
  }
  return decide(state, {});
}

void ContactPhases::add_grip_transitions(std::size_t k, const Dynamics& dynamics, std::vector<Transition>& transitions,
                                         Needs& needs) {
  const ContactPoint& point = contacts_.points[k];
  const ContactState state = states_[k];
  const auto watch = [&](std::function<double(const Snapshot&)> value, int side, PhaseEnd ends) {
    transitions.push_back({std::move(value), side});
    watched_.push_back({k, ends});
  };
  if (point.is_elastic_grip()) {
    const auto grips = std::make_shared<ElasticGrips>(contacts_.points, point.rope);
    const auto look = [grips, states = &states_](const Snapshot& s) -> const ElasticGrips& {
      grips->look(s.evaluator, s.qd, *states);
      return *grips;
    };
    const std::vector<std::size_t>& places = point.rope->grips;
    if (k == places.front())
      watch([look](const Snapshot& s) { return look(s).stretch(); }, state.closed ? 1 : -1, PhaseEnd::stretch);
    if (!state.closed || !point.has_friction()) return;
    const auto n = static_cast<std::size_t>(std::find(places.begin(), places.end(), k) - places.begin());
    if (state.direction != 0) {
      watch([look, n, sign = state.direction](const Snapshot& s) { return sign * look(s).slip(n); }, 1,
            PhaseEnd::slide);
    } else {
      watch([look, n](const Snapshot& s) { return look(s).margin(n); }, 1, PhaseEnd::slide);
    }
    return;
  }
  if (!point.has_friction() || !state.closed) return;
  if (state.tied) {
    watch([lines = point.lines, used = std::abs(state.held) * (1 - tied_rounding)](
              const Snapshot& s) { return lines->exponent(s.evaluator, {}).f - used; },
          1, PhaseEnd::slide);
    return;
  }
  needs.multipliers = true;
  if (state.direction != 0) {
    watch([slide = point.slide,
           sign = state.direction](const Snapshot& s) { return sign * s.evaluator.scalar_motion(slide, s.qd).rate; },
          1, PhaseEnd::slide);
    return;
  }
  const int row = dynamics.plan().element_row[at(point.slide)];
  watch(
      [loads = loads_.get(), lines = point.lines, k, row](const Snapshot& s) {
        const double before = loads->normal_from(k, s.qd, s.lambda), behind = before - s.lambda[at(row)];
        const double most = std::exp(lines->exponent(s.evaluator, {}).f);
        return std::min(before * most - behind, behind * most - before);
      },
      1, PhaseEnd::slide);
}

}  // namespace catena
