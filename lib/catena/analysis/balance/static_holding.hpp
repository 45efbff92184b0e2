// Finds groups of bodies that no constraint and no force element ties to the ground.
//
// The energy of such a group either has no minimum (a load acts on it) or does not depend on its place; both are found
// before any equation is solved, by following the elements from body to body.
#pragma once

#include <optional>
#include <span>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/base/status.hpp"

namespace catena {

/// `refused` (no load acts on the loose group) or `unbounded` (a load does), naming its bodies; nothing if every body
/// is tied to the ground. The system must have been moved to a configuration.
std::optional<Report> find_loose_bodies(const StaticSystem& system, const Evaluator& evaluator);

}  // namespace catena
