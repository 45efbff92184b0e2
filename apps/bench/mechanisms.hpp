// Mechanisms of any size for benchmarks, built in memory.
#pragma once

#include <memory>

#include "catena/model/model.hpp"

namespace bench {

/// A chain of n rods of 1 m and 1 kg pinned to each other and to the ground, angles 0.3 sin(k).
std::shared_ptr<catena::Model> chain(int links);

/// A crank that drives n four-bars in a row: the rocker of each is the crank of the next. 2 n + 1 bodies, all driven.
std::shared_ptr<catena::Model> dyad_ladder(int dyads);

/// A scissor lift of n stages on a slide, driven at its lowest arm: 2 n bodies.
std::shared_ptr<catena::Model> scissor_lift(int stages);

}  // namespace bench
