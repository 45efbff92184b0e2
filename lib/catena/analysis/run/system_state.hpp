// The state of a mechanism, passed from one analysis of a scene to the next: absolute, in model order, so that it stays
// valid for other plans and parameters.
//
// Of ropes the places say how they lie but for whole turns: how far they are wound belongs to the state. So does where
// curves touch, of several places that bodies allow, and which constraints have been released: who starts an analysis
// from a state leaves their equations out (PlanOptions::released_elements).
#pragma once

#include <vector>

#include "catena/elements/element.hpp"
#include "catena/model/rope_turns.hpp"

namespace catena {

struct SystemState {
  double t = 0;
  std::vector<double> q;   ///< [x, y, phi] of every body's centroid, m, m, rad; empty: the given configuration
  std::vector<double> qd;  ///< velocities; empty: none known
  /// At q, one for each of rope_routes(); empty: as q alone has them.
  std::vector<RopeTurns> ropes{};
  /// Where contacts on curves are at q; elements that are not among them search from the given configuration.
  std::vector<CurvePlace> curves{};
  /// Constraints and drivers that do not hold, ascending: an event released them, or has not engaged them yet.
  std::vector<int> released{};
  /// Those that hold where an event released or engaged them, ascending: they do so in a motion that goes on from here,
  /// whatever its events begin with.
  std::vector<int> held{};
};

}  // namespace catena
