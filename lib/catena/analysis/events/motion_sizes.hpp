// The sizes that a motion itself has: what rounding of watched numbers is a part of. Nothing here has a length, a time
// or a mass of its own, so that what is seen of a motion does not depend on units.
//
//   L   the length scale      F = max(|Q|, m v^2 / L)      V = max(|v|, sqrt(L F / M))
//
// Q: loads, of moments and angles in units of L; v: velocities, m: the mass of each coordinate, M: the largest. At
// rest, loads in balance give V a size, too. Zero where nothing moves and nothing is loaded. Units: m, m/s, N.
#pragma once

#include <span>

#include "catena/base/unit_kind.hpp"

namespace catena {

struct MotionSizes {
  /// What may be nothing but rounding counts as a number of this part of the size of its kind, that of some thousand
  /// operations on what is as large: 1e-14 of it and less is zero then (event_watch.hpp).
  static constexpr double least_part = 0.1;

  double length = 0, speed = 0, force = 0;

  /// Of a number of this unit; 1 of a pure number or an angle, 0 where it has none.
  double of(UnitKind unit) const;
  /// Those of another instant of the same motion count as well.
  void take(const MotionSizes& other);
};

/// Three entries a body: x, y and the angle. Of a driven motion velocities may be all there is.
MotionSizes sizes_of_motion(double length, std::span<const double> qd, std::span<const double> loads = {},
                            std::span<const double> mass = {});

}  // namespace catena
