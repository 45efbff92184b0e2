// Mechanisms of any size for benchmarks, built in memory.
#pragma once

#include <memory>
#include <string>

#include "catena/model/model.hpp"

namespace bench {

/// A chain of n rods of 1 m and 1 kg pinned to each other and to the ground, angles 0.3 sin(k).
std::shared_ptr<catena::Model> chain(int links);

/// A crank that drives n four-bars in a row: the rocker of each is the crank of the next. 2 n + 1 bodies, all driven.
std::shared_ptr<catena::Model> dyad_ladder(int dyads);

/// A scissor lift of n stages on a slide, driven at its lowest arm: 2 n bodies.
std::shared_ptr<catena::Model> scissor_lift(int stages);

/// A square lattice of rods, `side` cells each way, between a base and a wall that turns about its foot; driven at the
/// rod farthest from both, so that all its loops depend on each other. 2 side^2 + 1 bodies.
std::shared_ptr<catena::Model> lattice(int side);

/// Eccentric cams on one shaft, each with a flat follower on a guide: 2 n bodies.
std::shared_ptr<catena::Model> camshaft(int cams);

/// Gears in a row, each driven by the one before: n bodies.
std::shared_ptr<catena::Model> gear_train(int gears);

/// A uniform rod of 1 kg from `from` to `to`; its number.
int add_rod(catena::Model& model, const std::string& label, catena::Vec2<double> from, catena::Vec2<double> to);

}  // namespace bench
