// Gradients of measures of a motion by the way back (motion_adjoint.hpp): for any number of parameters what a few runs
// cost.
//
//   m = sum over pulses of weight x c(q, qd, qdd, lambda, p) at t      dm/dp = the adjoint's + sum weight x c_p
//
// States at which measures look are kept while the motion runs; what columns change by with them is found at the end.
// Not for columns of work and dissipated energy. Source: apps/manual/sensitivity.md.
#pragma once

#include <map>

#include "catena/analysis/measures/measure_set.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"

namespace catena {

class MotionMeasures final : public MotionAdjoint {
 public:
  MotionMeasures(const Evaluator& evaluator, const DesignModels& models, int parameters, GivenByModel start)
      : MotionAdjoint(evaluator, models, parameters, start) {}

  /// Keeps the state at an instant at which measures look.
  void keep(const Snapshot& snapshot);
  /// By measure, then parameter; nothing, and why() says it, where there are none.
  std::optional<Gradients> find_gradients(const ColumnSet& columns,
                                          const std::vector<std::vector<ColumnPulse>>& pulses);

 private:
  struct State {
    std::vector<double> q, qd, qdd, lambda;
  };
  std::map<double, State> states_;
};

}  // namespace catena
