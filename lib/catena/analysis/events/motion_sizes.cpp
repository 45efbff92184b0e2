#include "catena/analysis/events/motion_sizes.hpp"

#include <algorithm>
#include <cmath>

namespace catena {

double MotionSizes::of(UnitKind unit) const {
  switch (unit) {
    case UnitKind::none:
    case UnitKind::angle:
      return 1;
    case UnitKind::length:
      return length;
    case UnitKind::velocity:
      return speed;
    case UnitKind::angular_velocity:
      return speed / length;
    case UnitKind::acceleration:
      return speed * speed / length;
    case UnitKind::angular_acceleration:
      return speed * speed / (length * length);
    case UnitKind::force:
      return force;
    case UnitKind::torque:
    case UnitKind::energy:
      return force * length;
    case UnitKind::power:
      return force * speed;
    case UnitKind::momentum:
      return speed > 0 ? force * length / speed : 0;
    case UnitKind::angular_momentum:
      return speed > 0 ? force * length * length / speed : 0;
    default:
      return 0;
  }
}

void MotionSizes::take(const MotionSizes& other) {
  length = std::max(length, other.length);
  speed = std::max(speed, other.speed);
  force = std::max(force, other.force);
}

MotionSizes sizes_of_motion(double length, std::span<const double> qd, std::span<const double> loads,
                            std::span<const double> mass) {
  MotionSizes sizes{.length = length};
  double heaviest = 0;
  for (std::size_t c = 0; c < qd.size(); ++c) {
    const double unit = c % 3 == 2 ? length : 1, v = std::abs(qd[c]) * unit;
    const double load = c < loads.size() ? std::abs(loads[c]) / unit : 0;
    const double m = c < mass.size() ? mass[c] / (unit * unit) : 0;
    sizes.speed = std::max(sizes.speed, v);
    sizes.force = std::max({sizes.force, load, m * v * v / length});
    heaviest = std::max(heaviest, m);
  }
  if (heaviest > 0) sizes.speed = std::max(sizes.speed, std::sqrt(length * sizes.force / heaviest));
  return sizes;
}

}  // namespace catena
