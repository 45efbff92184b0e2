// Finds the mechanisms of a scene that should have steps of their own: those whose pace differs from that of the
// others.
//
// The pace of a mechanism, rad/s, is estimated from its given configuration and velocities as the largest of
//   |v| / L   |omega|   sqrt(|F| / (m L))   sqrt(|n| / J)   sqrt(k / m)   sqrt(k_t / J)   |c'| (/ L)   sqrt(|c''|) (/
//   L)
// over its bodies and drivers: L the scene's length scale, F and n gravity and applied loads, k and k_t diagonal
// entries of the stiffness, c the drivers' values. It need not be accurate: any division gives right results; only the
// cost depends on it. Mechanisms of one pace share their steps, since each evaluation then serves all of them.
#pragma once

#include <memory>
#include <vector>

#include "catena/model/model.hpp"

namespace catena {

/// Bodies (of the model) by class: mechanisms that no element ties to each other, sorted by pace and divided where it
/// is more than three times that of the slowest in the class. Behind these, each mechanism that one-sided elements or
/// dry friction act on: it has instants of its own at which it changes, with which the others have nothing to do. Fixed
/// bodies are in none.
std::vector<std::vector<int>> classes_of_pace(const std::shared_ptr<const Model>& model);

}  // namespace catena
