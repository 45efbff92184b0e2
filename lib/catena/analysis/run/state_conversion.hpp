// Converts between states that analyses pass on (absolute, model order) and configurations that they compute with (plan
// order, positions relative to the bodies' origins; see assembly/plan.hpp). Lengths m, angles rad.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/run/system_state.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena {

// A state of another model, or with numbers that are not finite, throws std::invalid_argument.

/// Puts the moving bodies where the state has them; q (size coordinates()) keeps the rest, all if the state has none.
void take_over_places(Evaluator& evaluator, const SystemState& state, std::span<double> q);

/// Where a body of the model is at q: the frame of its author, in the ground frame. Throws std::out_of_range for a
/// number that no body has.
Frame<double> frame_of(const Evaluator& evaluator, std::span<const double> q, int body);

/// The state's configuration, size coordinates(); that of the model where the state has none.
std::vector<double> configuration_of(Evaluator& evaluator, const SystemState& state);

/// The state's velocities, size coordinates(); zero for bodies that do not move, empty where the state has none.
std::vector<double> velocities_of(const Evaluator& evaluator, const SystemState& state);

/// The state of a configuration; `qd` empty: without velocities.
SystemState state_of(const Evaluator& evaluator, double t, std::span<const double> q, std::span<const double> qd = {});

}  // namespace catena
