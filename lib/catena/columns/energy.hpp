// Energy and momentum of a mechanism, summed over its bodies.
//
//   kinetic    sum (m |v|^2 + J omega^2) / 2            potential   Evaluator::potential_energy
//   momentum   sum m v                                  angular     sum m cross(r_c, v) + J omega, ground's origin
//
// m, J about the centroid c, whose position and velocity are r_c and v. Bodies without a mass count nothing: ask
// body_without_mass() first. Units: J, kg m/s, kg m^2/s. Signs: apps/manual/dynamics.md#energy.
#pragma once

#include "catena/columns/snapshot.hpp"

namespace catena {

template <class S>
struct BasicMomentum {
  Vec2<S> linear;
  S angular{};
};
using Momentum = BasicMomentum<double>;

double kinetic_energy(const Snapshot& snapshot);  ///< needs qd
double total_energy(const Snapshot& snapshot);    ///< needs qd
Momentum momentum(const Snapshot& snapshot);      ///< needs qd

/// The first body solved for whose mass, or inertia unless it is a particle, is not given; -1 if none.
int body_without_mass(const Model& model, const Plan& plan);

}  // namespace catena
