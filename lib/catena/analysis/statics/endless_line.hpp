// A straight line along which the constraints let the mechanism move for ever and along which its loads fall: there the
// energy has no minimum, wherever a search went.
//
//   q(s) = q + s v,   Phi(q(s)) = 0,   V(q(s)) = V(q) - F s,   F > 0        v over columns, m and rad; s >= 0; F N
//
// v is what the unbalanced forces have in common with the motions without stiffness: bodies on straight guides that
// nothing holds in their directions, wheels on which a torque acts. Where bodies turn along it, which is no straight
// line, v is the way of those tied to each other, all moved alike. That it is such a line is tried out
// (solvers/endless_fall.hpp).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

struct EndlessLine {
  std::vector<double> direction;  ///< v over columns, its largest component 1 (m or rad)
  double force = 0;               ///< F, the work of the loads along v
};

/// From the configuration q, at which the system is left with its exact K. Nothing where there is no such line, and
/// where the mechanism is too large for dense algebra.
std::optional<EndlessLine> find_endless_line(StaticSystem& system, std::span<const double> q);

}  // namespace catena
