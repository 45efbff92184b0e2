// Derivatives of an assembled configuration: start_derivatives.hpp, without velocities.
#pragma once

#include "catena/analysis/sensitivity/start_derivatives.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"

namespace catena {

class AssemblyDerivatives final : public StateDerivatives {
 public:
  /// `from_model`: the place follows from what the model gives, not from where an earlier analysis ended.
  AssemblyDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters, bool from_model)
      : StateDerivatives(evaluator, models, parameters), from_model_(from_model) {}

  bool find(const Snapshot& snapshot) override {
    evaluator().set_time(snapshot.t);
    StartDerivatives start(evaluator(), {.places = from_model_});
    for (Group& group : groups()) {
      lift_state(group, snapshot);
      if (!start.find_places(group.mechanism, group.count, group.q))
        return fail("the assembled configuration has no derivative: " + start.why());
      if (!start.lack().empty()) lack_derivatives(start.lack());
      group.mechanism.set_state(group.q);
    }
    return true;
  }

 private:
  bool from_model_;
};

}  // namespace catena
