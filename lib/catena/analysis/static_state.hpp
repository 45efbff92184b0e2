// Between states as analyses hand them on (absolute, model order) and configurations as static analyses use them (plan
// order, positions relative to the bodies' origins; see assembly/plan.hpp). Lengths m, angles rad.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/system_state.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena {

/// The state's configuration, size coordinates(); that of the model where the state has none.
std::vector<double> configuration_of(const Evaluator& evaluator, const SystemState& state);

/// The state of a configuration, at rest.
SystemState state_of(const Evaluator& evaluator, double t, std::span<const double> q);

}  // namespace catena
