// Forces without an energy, as reports name them: those that turn with their body, and laws of state.
#pragma once

#include <string>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// "forces that turn with their body have no energy", or that a law has none.
std::string forces_without_energy(const Model& model);

/// Whether forces depend on velocities: any motion loses power to damping, or a law of state reads a rate. The
/// evaluator must be at a configuration.
bool is_damped(const Evaluator& evaluator);

/// Refuses an analysis of the stability of such forces in a mechanism that is too large for dense algebra.
Report too_large_without_energy(const Model& model, int freedoms, int most_freedoms);

}  // namespace catena
