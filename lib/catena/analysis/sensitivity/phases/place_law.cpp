#include "catena/analysis/sensitivity/phases/place_law.hpp"

#include "catena/base/at.hpp"

namespace catena {

DesignScalar PlaceLaw::compliant_force(const PlaceMotion& motion) const {
  const DesignScalar d = -motion.gap;
  DesignScalar spring = place.k * d;
  if (point.exponent != 1 && d.v != 0)
    spring = d.v > 0 ? place.k * pow(d, place.exponent) : -(place.k * pow(-d, place.exponent));
  return spring - place.c * motion.gap_rate;
}

DesignScalar PlaceLaw::row_factor(const DesignScalar& gap) const {
  if (!place.has_range) return DesignScalar(1.0);
  return DesignScalar(1.0) - DesignScalar(2.0) * gap / place.range;
}

DesignScalar PlaceLaw::slip_sign(const DesignScalar& slip) const {
  if (point.is_exact()) return DesignScalar(state.direction);
  return tanh(slip / place.smoothing);
}

DesignScalar PlaceLaw::normal(const PlaceMotion& motion, std::span<const DesignScalar> lambda) const {
  if (point.kind == ContactKind::compliant) return compliant_force(motion);
  if (point.kind == ContactKind::rigid) return -lambda[at(gap_row)];
  const DesignScalar &a = lambda[at(joint_row)], &b = lambda[at(joint_row) + 1];
  if (has_moment) return place.radius * (place.has_length ? abs(a) + abs(b) / place.half_length : abs(a));
  const DesignScalar squares = a * a + b * b;
  return squares.v > 0 ? place.radius * sqrt(squares) : DesignScalar(0.0);
}

bool PlaceLaw::ends_by_gap(const PlaceMotion& motion, PhaseEnd ends) const {
  if (ends == PhaseEnd::slide || state.closed) return false;
  return ends == PhaseEnd::contact || point.c == 0 || -motion.gap.v < compliant_force(motion).v;
}

DesignScalar PlaceLaw::end_value(const PlaceMotion& motion, std::span<const DesignScalar> lambda, PhaseEnd ends) const {
  if (ends == PhaseEnd::slide) {
    if (state.direction != 0) return motion.slip;
    return place.mu_static * normal(motion, lambda) - abs(lambda[at(slide_row)]);
  }
  if (state.closed) return normal(motion, lambda);
  return ends_by_gap(motion, ends) ? motion.gap : compliant_force(motion);
}

}  // namespace catena
