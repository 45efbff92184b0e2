#include "catena/analysis/sensitivity/phases/place_law.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// k d^n, odd in d. Its derivative by n is d^n ln d, of n = 1 as well, and none where d = 0; that by d is 0 there for n
// above 1, and has no bound below.
DesignScalar spring_force(const DesignPlace& place, const DesignScalar& d) {
  const bool linear = place.exponent.v == 1;
  const bool moves = std::any_of(place.exponent.d.begin(), place.exponent.d.end(), [](double x) { return x != 0; });
  if (linear && (!moves || d.v == 0)) return place.k * d;
  if (d.v == 0) return DesignScalar(0.0);
  return d.v > 0 ? place.k * pow(d, place.exponent) : -(place.k * pow(-d, place.exponent));
}

}  // namespace

DesignScalar PlaceLaw::compliant_force(const PlaceMotion& motion) const {
  return spring_force(place, -motion.gap) - place.c * motion.gap_rate;
}

double PlaceLaw::compliant_size(const PlaceMotion& motion) const {
  return std::abs(spring_force(place, -motion.gap).v) + std::abs(place.c.v * motion.gap_rate.v);
}

DesignScalar PlaceLaw::row_factor(const DesignScalar& gap) const {
  if (!place.has_range) return DesignScalar(1.0);
  return DesignScalar(1.0) - DesignScalar(2.0) * gap / place.range;
}

DesignScalar PlaceLaw::coefficient(const DesignScalar& slip) const {
  if (state.tied) return DesignScalar(-state.held);
  if (point.is_exact()) return place.mu * DesignScalar(state.direction);
  return place.mu * tanh(slip / place.smoothing);
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
  if (ends == PhaseEnd::slide) return false;
  // Where nothing is damped what presses ends with the depth; of a power of it that tells the instant better.
  if (ends == PhaseEnd::pressing && point.c == 0) return true;
  if (state.closed) return false;
  return ends == PhaseEnd::contact || -motion.gap.v < compliant_force(motion).v;
}

DesignScalar PlaceLaw::end_value(const PlaceMotion& motion, std::span<const DesignScalar> lambda, PhaseEnd ends) const {
  if (ends == PhaseEnd::slide) {
    if (state.direction != 0) return motion.slip;
    return place.mu_static * normal(motion, lambda) - abs(lambda[at(slide_row)]);
  }
  if (ends_by_gap(motion, ends)) return motion.gap;
  return state.closed ? normal(motion, lambda) : compliant_force(motion);
}

bool PlaceLaw::has_passed(const PlaceMotion& motion, std::span<const DesignScalar> lambda, PhaseEnd ends, double length,
                          double speed) const {
  if (ends == PhaseEnd::slide && state.direction != 0)
    return motion.slip.v * state.direction < -no_speed * (point.turns ? 1 / length : 1) * speed;
  if (ends == PhaseEnd::slide) {
    const double pressed = std::abs(place.mu_static.v * normal(motion, lambda).v);
    return pressed - std::abs(lambda[at(slide_row)].v) < -thresholds::no_force * pressed;
  }
  if (point.kind != ContactKind::compliant) return false;
  const double force = compliant_force(motion).v, none = thresholds::no_force * compliant_size(motion);
  if (state.closed) return force < -none;
  return -motion.gap.v > thresholds::closed_gap * (point.turns ? 1 : length) && force > none;
}

}  // namespace catena
