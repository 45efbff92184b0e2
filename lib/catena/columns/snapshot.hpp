// The state of a mechanism at one instant, as columns read it.
//
// Vectors are in plan order (three coordinates a body, the ground's zeros last; see assembly/evaluate.hpp). Empty spans
// mean: not computed; the columns that need them must not be asked for. `lambda` has one multiplier a row of the plan
// and belongs to the solver's scaled equations: the published multiplier is scale x lambda.
#pragma once

#include <span>

#include "catena/assembly/evaluate.hpp"

namespace catena {

/// What a contact presses with, its friction, along the curve or in a joint, on j, and its slip, j relative to i.
/// Units: N or N m, m/s or rad/s. Of a rope: its tension at the end i, of an elastic one what friction on pulleys adds
/// there; and what the tension at the end j exceeds that at i by.
struct ContactLoad {
  double force = 0, friction = 0, slip = 0;
  bool glides = false;  ///< a contact that touches without friction: its slip is that of touching.hpp
};

struct Snapshot {
  const Evaluator& evaluator;  ///< set to this time and configuration
  double t = 0;
  std::span<const double> q{}, qd{}, qdd{}, lambda{};
  double residual = 0;                    ///< largest constraint residual, m; angles times the length scale
  double work = 0;                        ///< of drivers and applied loads since the start, J
  double dissipated = 0;                  ///< J
  double initial_energy = 0;              ///< total_energy() at the start, J
  std::span<const double> driver_work{};  ///< by number of the element, J
  /// In motion with contacts, by number of the element; empty: there are none, or forces were not computed.
  std::span<const ContactLoad> contacts{};
  double contact_energy = 0;  ///< stored in elastic contacts, J
};

/// The quantities that an analysis must compute for the requested columns.
struct Needs {
  bool velocity = false;
  bool acceleration = false;
  bool multipliers = false;
  bool work = false;  ///< integrals of power: work of drivers and loads, dissipation, the energy at the start

  Needs& operator|=(const Needs& other) {
    velocity |= other.velocity;
    acceleration |= other.acceleration;
    multipliers |= other.multipliers;
    work |= other.work;
    return *this;
  }
};

}  // namespace catena
