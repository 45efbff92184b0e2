// Looks at a driven motion at any instant, in any order, beside the run that gives its rows.
//
// A second Kinematics of the same model follows the motion from a state that the run gave: what is asked of it disturbs
// neither the run's predictions nor its account of work. Work and dissipated energy are therefore not to be had.
#pragma once

#include <optional>

#include "catena/analysis/kinematics/kinematics.hpp"

namespace catena {

class KinematicLook {
 public:
  /// `needs`: what snapshots must hold.
  KinematicLook(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const KinematicsOptions& options,
                const Needs& needs)
      : kinematics_(std::move(model), plan_options, options), needs_(needs) {
    needs_.work = false;
  }

  /// Starts from where another evaluator's snapshot is.
  void start_from(const Snapshot& snapshot) {
    kinematics_.start_from(state_of(snapshot.evaluator, snapshot.t, snapshot.q));
  }
  /// The mechanism at t; nothing where the motion cannot be followed there. Valid until the next call.
  std::optional<Snapshot> at(double t) {
    if (!kinematics_.move_to(t).ok() || !kinematics_.solve_rates(needs_).ok()) return {};
    kinematics_.evaluator().set_configuration(kinematics_.q());
    const bool velocity = needs_.velocity || needs_.acceleration || needs_.multipliers;
    const bool acceleration = needs_.acceleration || needs_.multipliers;
    const std::span<const double> none;
    return Snapshot{.evaluator = kinematics_.evaluator(),
                    .t = t,
                    .q = kinematics_.q(),
                    .qd = velocity ? kinematics_.qd() : none,
                    .qdd = acceleration ? kinematics_.qdd() : none,
                    .lambda = needs_.multipliers ? kinematics_.lambda() : none};
  }

 private:
  Kinematics kinematics_;
  Needs needs_;
};

}  // namespace catena
