// Looks at a driven motion at any instant, in any order, beside the run that gives its rows.
//
// A second Kinematics of the same model follows the motion from a state that the run gave: what is asked of it disturbs
// neither the run's predictions nor its account of work. Where work is needed it sums up its own, on top of what the
// run's had come to in that state.
#pragma once

#include <optional>
#include <vector>

#include "catena/analysis/kinematics/kinematics.hpp"

namespace catena {

class KinematicLook {
 public:
  /// `needs`: what snapshots must hold.
  KinematicLook(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const KinematicsOptions& options,
                const Needs& needs)
      : kinematics_(std::move(model), plan_options, options), needs_(needs) {
    if (needs_.work) needs_.velocity = needs_.acceleration = needs_.multipliers = true;
  }

  /// Starts from where another evaluator's snapshot is.
  void start_from(const Snapshot& snapshot) {
    start_ = state_of(snapshot.evaluator, snapshot.t, snapshot.q);
    work_ = snapshot.work;
    dissipated_ = snapshot.dissipated;
    initial_energy_ = snapshot.initial_energy;
    driver_work_before_.assign(snapshot.driver_work.begin(), snapshot.driver_work.end());
    driver_work_ = driver_work_before_;
    set_out();
  }
  /// The same from a state, in which no work was done yet.
  void start_from(const SystemState& state) {
    const Evaluator& evaluator = kinematics_.evaluator();
    start_ = state.q.empty() ? state_of(evaluator, state.t, evaluator.given_configuration()) : state;
    work_ = dissipated_ = 0;
    initial_energy_.reset();
    driver_work_before_.assign(evaluator.model().elements.size(), 0.0);
    driver_work_ = driver_work_before_;
    set_out();
  }
  /// Where the motion cannot be followed it goes back to its start: from now on to this place, unless work is summed
  /// up.
  void return_to(const Snapshot& snapshot) {
    if (!needs_.work) start_ = state_of(snapshot.evaluator, snapshot.t, snapshot.q);
  }
  /// The mechanism at t; nothing where the motion cannot be followed there. Valid until the next call.
  std::optional<Snapshot> at(double t) {
    if (!follows_ || !kinematics_.move_to(t).ok() || !kinematics_.solve_rates(needs_).ok()) {
      // It may have come part of the way, with a part of the work.
      if (follows_) set_out();
      return {};
    }
    kinematics_.evaluator().set_configuration(kinematics_.q());
    Snapshot snapshot = kinematics_.snapshot();
    if (needs_.multipliers) snapshot.lambda = kinematics_.lambda();
    if (!needs_.work) return snapshot;
    for (std::size_t e = 0; e < driver_work_.size(); ++e)
      driver_work_[e] = driver_work_before_[e] + snapshot.driver_work[e];
    snapshot.driver_work = driver_work_;
    snapshot.work += work_;
    snapshot.dissipated += dissipated_;
    if (initial_energy_) snapshot.initial_energy = *initial_energy_;
    return snapshot;
  }

 private:
  void set_out() {
    kinematics_.start_from(start_);
    follows_ = !needs_.work || kinematics_.sum_up_work().ok();
  }

  Kinematics kinematics_;
  SystemState start_;
  Needs needs_;
  bool follows_ = true;
  double work_ = 0, dissipated_ = 0;      // of the run, where this began
  std::optional<double> initial_energy_;  // the same; nothing: the run begins there
  std::vector<double> driver_work_before_, driver_work_;
};

}  // namespace catena
