// Gradients of measures of a motion by the way back (motion_adjoint.hpp): for any number of parameters what a few runs
// cost.
//
//   m = sum over pulses of weight x c(q, qd, qdd, lambda, p) at t      dm/dp = the adjoint's + sum weight x c_p
//
// States at which measures look are kept while the motion runs; what columns change by with them is found at the end.
// Events of the list that strike are passed; where one releases or engages a constraint, where contacts change, or
// several events act at once, there is no gradient (phased_measures.hpp has those). Not for columns of work and
// dissipated energy. Source: apps/manual/sensitivity.md.
#pragma once

#include <map>

#include "catena/analysis/adjoint/measure_adjoint.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"

namespace catena {

class MotionMeasures final : public MotionAdjoint, public PhaseWitness, public MeasureAdjoint {
 public:
  MotionMeasures(const Evaluator& evaluator, const DesignModels& models, int parameters, GivenByModel start,
                 const DerivativeAim& aim = {})
      : MotionAdjoint(evaluator, models, parameters, start, aim) {}

  /// The events of the list; before the motion, of whose phases this object is the witness then.
  void follow(std::vector<DesignEvent> events) { events_ = std::move(events); }
  void begin(const MotionPhase& phase) override;
  void cover(const MotionStretch& stretch) override;
  /// Keeps the state at an instant at which measures look.
  void keep(const Snapshot& snapshot) override;
  /// By measure, then parameter; nothing, and why() says it, where there are none.
  std::optional<Gradients> find_gradients(const ColumnSet& columns,
                                          const std::vector<std::vector<ColumnPulse>>& pulses) override;

 private:
  struct State {
    std::vector<double> q, qd, qdd, lambda;
  };
  EventSlopes slopes_of_event(int event, const Snapshot& before) override;

  std::map<double, State> states_;
  std::vector<DesignEvent> events_;
  std::vector<int> released_;  // in the first phase
  struct {
    int event = -1;
    std::optional<double> by_time{};  // how fast its column changed
  } ended_by_;                        // what ended the last stretch
};

}  // namespace catena
