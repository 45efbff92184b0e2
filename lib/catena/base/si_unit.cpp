#include "catena/base/si_unit.hpp"

#include "catena/base/row_sink.hpp"

namespace catena {

std::string_view ColumnInfo::unit_text() const {
  return unit == UnitKind::own ? std::string_view(own_unit) : si_unit(unit);
}

std::string_view si_unit(UnitKind kind) {
  switch (kind) {
    case UnitKind::none:
      return "1";
    case UnitKind::length:
      return "m";
    case UnitKind::angle:
      return "rad";
    case UnitKind::mass:
      return "kg";
    case UnitKind::inertia:
      return "kg m^2";
    case UnitKind::time:
      return "s";
    case UnitKind::velocity:
      return "m/s";
    case UnitKind::angular_velocity:
      return "rad/s";
    case UnitKind::acceleration:
      return "m/s^2";
    case UnitKind::angular_acceleration:
      return "rad/s^2";
    case UnitKind::squared_frequency:
      return "rad^2/s^2";
    case UnitKind::force:
      return "N";
    case UnitKind::torque:
      return "N m";
    case UnitKind::energy:
      return "J";
    case UnitKind::power:
      return "W";
    case UnitKind::momentum:
      return "kg m/s";
    case UnitKind::angular_momentum:
      return "kg m^2/s";
    case UnitKind::stiffness:
      return "N/m";
    case UnitKind::damping:
      return "N s/m";
    case UnitKind::torsion_stiffness:
      return "N m/rad";
    case UnitKind::torsion_damping:
      return "N m s/rad";
    case UnitKind::own:
      return "";
  }
  return "1";
}

}  // namespace catena
