// A path that starts at a critical point: an equilibrium at which the stiffness against some motion vanishes.
//
// Nothing at the point alone tells a limit point from a branch point, or either from a mechanism that some motion costs
// nothing at all. A little before it, at p - d and along the same path, the equilibrium is regular, and from there the
// point is one like others on a path (path_critical.hpp): the inertia changes between p - d and p + d, or it does not.
//
//   d = 1e-3 of the parameter's range: stiffnesses change by 1e-3 of theirs, which rounding (1e-10) does not hide, and
//   the path bends by as little.
//
// Singular: at a limit point the path has no place at p + d or none at p - d: the step then goes along the path's own
// tangent from the side that has one. Where neither has, or modes do not change, nothing is found.
#pragma once

#include <optional>

#include "catena/analysis/stability/path_critical.hpp"

namespace catena {

struct CriticalStart {
  CriticalPoint critical;
  PathPoint direction;  ///< of the path behind the point, along which it goes straight on
  PathStability modes_before, modes_after;
};

/// What lies around the start x of a path that goes along `direction`, the one of the parameter alone. Leaves the
/// system at x.
std::optional<CriticalStart> look_around(PathSystem& system, const PathPoint& x, const PathPoint& direction);

}  // namespace catena
