// Physical dimensions, to check that a quantity fits the field it is given to.
//
// A dimension is the exponents of length, mass, time and angle. The angle counts as a dimension of its own, so that
// rad/s is not 1/s and a torsion spring wants N m/rad, not N m; a torque is N m. Dimensions multiply and divide, which
// gives the coefficients of a polynomial in time their units: m, m/s, m/s^2, m/s^3 ...
#pragma once

#include <string>

#include "catena/base/unit_kind.hpp"

namespace catena {

struct Dimension {
  int length = 0, mass = 0, time = 0, angle = 0;

  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
  friend constexpr Dimension operator*(const Dimension& a, const Dimension& b) {
    return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.angle + b.angle};
  }
  friend constexpr Dimension operator/(const Dimension& a, const Dimension& b) { return a * power(b, -1); }
  friend constexpr Dimension power(const Dimension& a, int n) {
    return {a.length * n, a.mass * n, a.time * n, a.angle * n};
  }
};

constexpr Dimension dimension_of(UnitKind kind) {
  constexpr Dimension length{1, 0, 0, 0}, mass{0, 1, 0, 0}, time{0, 0, 1, 0}, angle{0, 0, 0, 1};
  constexpr Dimension force{1, 1, -2, 0};
  switch (kind) {
    case UnitKind::none:
    case UnitKind::own:
      return {};
    case UnitKind::length:
      return length;
    case UnitKind::angle:
      return angle;
    case UnitKind::mass:
      return mass;
    case UnitKind::inertia:
      return mass * length * length;
    case UnitKind::time:
      return time;
    case UnitKind::velocity:
      return length / time;
    case UnitKind::angular_velocity:
      return angle / time;
    case UnitKind::acceleration:
      return length / (time * time);
    case UnitKind::angular_acceleration:
      return angle / (time * time);
    case UnitKind::squared_frequency:
      return angle * angle / (time * time);
    case UnitKind::force:
      return force;
    case UnitKind::torque:
    case UnitKind::energy:
      return force * length;
    case UnitKind::power:
      return force * length / time;
    case UnitKind::momentum:
      return mass * length / time;
    case UnitKind::angular_momentum:
      return mass * length * length / time;
    case UnitKind::stiffness:
      return force / length;
    case UnitKind::damping:
      return force * time / length;
    case UnitKind::torsion_stiffness:
      return force * length / angle;
    case UnitKind::torsion_damping:
      return force * length * time / angle;
  }
  return {};
}

/// The SI unit, in the syntax scene files read: "kg m^2", "rad/s"; "1" for a pure number.
std::string si_unit(const Dimension& dimension);
/// Its name in messages: "a length", "a torque"; for a dimension without a name "a quantity in m/s^3".
std::string describe(const Dimension& dimension);
/// A quantity of this dimension as a user might write it: "120 mm", "30 deg"; 0.5 without quotes for a pure number.
std::string example(const Dimension& dimension);

}  // namespace catena
