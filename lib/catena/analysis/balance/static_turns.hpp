// Whole turns that a search has made and nothing in the mechanism counts.
//
//   phi_b - n 2 pi,  n = round((phi_b - start) / 2 pi)        for all bodies tied by what counts their turns alike
//
// Optimisers and shaken starts come to an equilibrium over many turns; the pose is the same without them. Bodies tied
// by angle rows, welds, gears, belts, racks, stops and springs against turning are taken back together, by the turns of
// the first of them; those that are tied to the ground so have wound something up and stay.
#pragma once

#include <span>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

/// Takes the turns out of q (plan order) and moves the system there; angles that were within half a turn stay.
void drop_whole_turns(StaticSystem& system, std::span<const double> start, std::span<double> q);

}  // namespace catena
