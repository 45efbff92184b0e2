// The physical kinds of quantity that fields and columns have: they determine the unit of a number, always SI and
// radians.
#pragma once

namespace catena {

enum class UnitKind {
  none,                  ///< 1
  length,                ///< m
  angle,                 ///< rad
  mass,                  ///< kg
  inertia,               ///< kg m^2
  time,                  ///< s
  velocity,              ///< m/s
  angular_velocity,      ///< rad/s
  acceleration,          ///< m/s^2
  angular_acceleration,  ///< rad/s^2
  squared_frequency,     ///< rad^2/s^2
  force,                 ///< N
  torque,                ///< N m
  energy,                ///< J
  power,                 ///< W
  momentum,              ///< kg m/s
  angular_momentum,      ///< kg m^2/s
  stiffness,             ///< N/m
  damping,               ///< N s/m
  torsion_stiffness,     ///< N m/rad
  torsion_damping,       ///< N m s/rad
  own,                   ///< what the author of a column says, or nothing known
};

}  // namespace catena
