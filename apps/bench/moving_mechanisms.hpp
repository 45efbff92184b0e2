// Mechanisms that move under forces, with independently known solutions.
#pragma once

#include <memory>

#include "catena/model/model.hpp"

namespace bench {

/// n uniform rods of 1 m and 1 kg in a straight horizontal line, at rest.
std::shared_ptr<catena::Model> straight_chain(int n);

/// IFToMM A02: n four-bars of 1 m side by side, upright, pushed to the right with 1 m/s.
std::shared_ptr<catena::Model> four_bars(int n);

/// Andrews' squeezing mechanism as the Test Set for IVP Solvers defines it.
std::shared_ptr<catena::Model> squeezer();

/// The Test Set's car axis: two masses on a bar, one of them guided along an axle that a road lifts.
std::shared_ptr<catena::Model> car_axis();

}  // namespace bench
