// Removes whole turns that a search has made and that no element of the mechanism counts.
//
//   phi_b - n 2 pi,  n = round((phi_b - start) / 2 pi)        for all bodies whose turns are counted together
//
// Optimisers and displaced starts may reach an equilibrium after many turns; the pose is the same without them. Bodies
// tied by angle rows, welds, gears, belts, racks, stops and springs against turning are turned back together, by the
// turns of the first of them; those tied to the ground in this way keep their turns, and so do racks and pinions, where
// turns are places.
#pragma once

#include <span>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

/// Takes the turns out of q (plan order) and moves the system there; angles that were within half a turn stay.
void drop_whole_turns(StaticSystem& system, std::span<const double> start, std::span<double> q);
/// Takes them out alone; whether there were some.
bool drop_whole_turns(const Plan& plan, std::span<const double> start, std::span<double> q);

}  // namespace catena
