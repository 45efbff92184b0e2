// Motion with contacts as a row of phases, in each of which every contact does one thing: it is open, presses, sticks
// or slides. A phase is integrated as a motion with the rows and forces of its state; it ends where one of these passes
// zero, located on the dense output to rounding:
//
//   open, rigid        the gap                        open, compliant    the lesser of depth and force
//   pressing           what presses                   slides             the slip, in its direction
//   sticks             mu_static N - |T|              hold each other    margin of all their shares (shared_forces.hpp)
//   a rope's grip      what its tensions may still differ by
//   elastic rope       its stretch, if it has grips (contact/elastic_grips.hpp)
//
// and where a rope meets or leaves a pulley (rope_phases.hpp).
//
// There contact_switch.hpp finds impacts and what every contact does next. Units as in contact_points.hpp.
#pragma once

#include <memory>
#include <vector>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/dynamics/rope_phases.hpp"

namespace catena {

class ContactPhases {
 public:
  /// `ropes`: follow their ways over pulleys.
  ContactPhases(std::shared_ptr<const Model> model, bool ropes);

  bool any() const { return !contacts_.points.empty() || (ropes_ && ropes_->any()); }
  /// Assembles, makes velocities consistent and finds what every contact does at the start; `state` is changed to that.
  /// `options`: of the plan, without the contacts.
  Report start(SystemState& state, const PlanOptions& options);
  /// Whether there is more than ropes, whose state a motion that is taken up does not know.
  bool has_places() const { return !contacts_.points.empty(); }
  /// Takes up a motion of ropes alone, where `state` has them.
  Report resume(const SystemState& state, std::vector<ContactEvent> events, const PlanOptions& options);
  bool started() const { return switch_ != nullptr; }
  /// Whether models of its phases differ in more than values: in the ways of ropes.
  bool changes_structure() const { return ropes_ && ropes_->any(); }
  std::size_t places() const { return contacts_.points.size(); }

  /// The model of the present phase; and what its plan needs more: rows of closed and sticking places hold.
  std::shared_ptr<const Model> model() const;
  void add_rows(PlanOptions& options) const { add_rows(options, states_); }
  /// Makes the forces of the phase for a Dynamics of model() and its plan, and has `watch` look for its end.
  void attach(Dynamics& dynamics, EventWatch& watch);
  /// Other constraints came or went, as `options` says: finds what every contact does then.
  Report change_constraints(const PlanOptions& options, SystemState& state);
  /// A blow: the same. `work`: what it does, J.
  Report strike(const Strike& strike, const PlanOptions& options, SystemState& state, double& work);
  /// What constraints exerted at the last of these jolts.
  std::vector<ConstraintImpulse> take_impulses() { return switch_->take_impulses(); }
  /// Functions of time jump, or their rates do: the same.
  Report meet_jump(SystemState& state) { return decide(state, {.jolts = true}); }
  /// The phase ended by a transition: finds the next one.
  Report change(int transition, SystemState& state);
  /// Why friction could not be found at the last evaluation, or nothing.
  std::string trouble() const { return loads_ ? loads_->trouble() : std::string(); }
  /// Where drivers moved on against closed places, if that is why the last phase could not be found.
  const std::optional<SingularPoint>& blocked() const { return switch_->blocked(); }
  const std::vector<ContactEvent>& events() const { return events_; }
  /// What holds now, and how velocities jumped when that was decided.
  const std::vector<ContactState>& states() const { return states_; }
  const std::vector<WatchedPlace>& watched() const { return watched_; }
  const std::optional<VelocityJump>& jump() const { return switch_->jump(); }
  /// What impacts made of restitutions, for the report; empty: what was asked for.
  std::string remark_on_impacts() const;
  /// Whether friction left open what moves; empty: it did not.
  std::string remark_on_states() const;
  /// How far ropes are wound at a place of the present phase.
  std::vector<RopeTurns> turns(const SystemState& state) const {
    return ropes_ ? ropes_->turns(state) : std::vector<RopeTurns>();
  }

 private:
  void add_rows(PlanOptions& options, const std::vector<ContactState>& states) const;
  void add_shared_transitions(const Dynamics& dynamics, std::vector<Transition>& transitions, Needs& needs);
  bool shares(std::size_t k) const;
  void add_transitions(std::size_t k, const Dynamics& dynamics, std::vector<Transition>& transitions, Needs& needs);
  void add_grip_transitions(std::size_t k, const Dynamics& dynamics, std::vector<Transition>& transitions,
                            Needs& needs);
  double scale_of(const WatchedPlace& watched) const;
  void lay_grips(const Evaluator& evaluator);
  // Of elastic ropes with grips.
  void start_elastic(const Evaluator& evaluator);
  void settle_elastic(const Evaluator& evaluator, std::span<const double> qd, const ContactSwitch::Cause& cause,
                      double t);
  void keep_stretches(const Evaluator& evaluator, const std::vector<double>& stretch_behind,
                      const std::vector<char>& touched, std::span<const double> qd);
  void make_switch(const PlanOptions& options);
  Report renew_switch(const PlanOptions& options, const SystemState& state);
  Report decide(SystemState& state, const ContactSwitch::Cause& cause);
  bool misses_closed() const;
  void meet_closed(SystemState& state) const;
  Report check_depth(std::span<const double> q);
  Report change_elastic(const WatchedPlace& watched, SystemState& state);
  Report change_way(std::size_t transition, SystemState& state);

  ContactModel contacts_;
  // As it was at first, and where a motion was first taken up: others refer to it.
  std::shared_ptr<const Model> first_, first_taken_up_;
  std::optional<RopePhases> ropes_;
  PlanOptions options_;  // the last ones, without the contacts
  std::unique_ptr<ContactSwitch> switch_;
  std::unique_ptr<ContactLoads> loads_;
  std::vector<ContactState> states_;
  std::vector<double> anchors_;        // by point: the value of the slide's equation while it sticks
  std::vector<WatchedPlace> watched_;  // by transition; behind these are those of ropes
  std::vector<ContactEvent> events_;
};

}  // namespace catena
