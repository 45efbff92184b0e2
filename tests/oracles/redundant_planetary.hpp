// Planetary gears with three or four planets of which one would do. z: what the carrier and, where the ring turns too,
// the sun have turned since the start.
//
//   sun s, planets p, ring r = s + 2 p:   s turn_sun + p turn_planet = (s + p) turn_carrier,   rolling inside likewise
#pragma once

#include "catena/elements/constraints/gear.hpp"
#include "oracles/random_mechanism.hpp"

namespace catena::testing {

/// Sun, carrier, three or four planets and a ring, which stands still or turns.
inline void planetary(RandomMechanism& m, bool free_ring) {
  const int planets = 3 + m.pick(2);
  const double sun = m.size * m.uniform(0.3, 1), planet = m.size * m.uniform(0.2, 0.6), ring = sun + 2 * planet;
  const Vec middle{m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)};
  std::vector<Vec> off;  // centroids of sun, carrier, ring, planets, from their axles in their own frames
  std::vector<double> start;
  const int first = free_ring ? 3 : 2;
  for (int b = 0; b < first + planets; ++b) {
    m.body(b < first ? ring : planet);
    const double reach = b < first ? sun : planet;
    off.push_back(m.pick(2) ? Vec{} : Vec{reach * m.uniform(-0.5, 0.5), reach * m.uniform(-0.5, 0.5)});
    start.push_back(m.uniform(-3, 3));
  }
  std::vector<double> spoke;
  for (int p = 0; p < planets; ++p) spoke.push_back(2 * std::numbers::pi * p / planets + m.uniform(-0.3, 0.3));
  m.motion.freedoms = free_ring ? 2 : 1;
  m.motion.places = [=](const JetCoordinates& z) {
    // z: what the carrier, then the sun turned since the start.
    const Jet carrier = z[0];
    const Real s = sun, p = planet, r = ring;
    const Jet sun_turn = free_ring ? z[1] : ((s + r) / s) * carrier;
    const Jet planet_turn = ((s + p) / p) * carrier - (s / p) * sun_turn;
    const Jet ring_turn = (p / r) * planet_turn + ((r - p) / r) * carrier;
    std::vector<JetPlace> places;
    const auto wheel = [&](JetPoint axle, Jet turn) {
      const std::size_t b = places.size();
      const Jet angle = turn + Jet{start[b]};
      places.push_back({axle + turned(angle, off[b]), angle});
    };
    wheel(fixed_point(middle), sun_turn);
    wheel(fixed_point(middle), carrier);
    if (free_ring) wheel(fixed_point(middle), ring_turn);
    for (const double at : spoke) {
      wheel(fixed_point(middle) + turned(carrier + Jet{at}, {sun + planet, 0}), planet_turn);
    }
    return places;
  };
  m.motion.rate = {m.some_rate(3), free_ring ? m.some_rate(3) : 0};
  m.place_bodies();
  for (int b = 0; b < first; ++b) m.pin(ground, middle, b, -1 * off[static_cast<std::size_t>(b)]);
  for (int p = 0; p < planets; ++p) {
    const int b = first + p;
    const Vec axle = middle + (sun + planet) * unit(spoke[static_cast<std::size_t>(p)]);
    m.pin(1, m.local_place(1, axle), b, -1 * off[static_cast<std::size_t>(b)]);
    Gear<> inner, outer;
    inner.s_i = -1 * off[0];
    inner.s_j = outer.s_j = -1 * off[static_cast<std::size_t>(b)];
    inner.radius_i = sun;
    inner.radius_j = outer.radius_j = planet;
    outer.radius_i = ring;
    outer.internal = true;
    outer.s_i = free_ring ? -1 * off[2] : middle;
    m.motion.model->add("", inner, 0, b);
    m.motion.model->add("", outer, free_ring ? 2 : ground, b);
  }
  m.add_springs();
}

}  // namespace catena::testing
