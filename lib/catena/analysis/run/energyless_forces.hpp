// Forces without an energy, as reports name them: those that turn with their body, and laws of state.
#pragma once

#include <string>
#include <string_view>

#include "catena/model/model.hpp"

namespace catena {

/// "forces that turn with their body have no energy", or that a law has none.
std::string forces_without_energy(const Model& model);

/// Why an analysis that needs an energy is refused; `what` is "paths of forces without one are"
/// and the like.
std::string refused_without_energy(const Model& model, std::string_view what);

}  // namespace catena
