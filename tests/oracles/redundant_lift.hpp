// Scissor lifts of one to three stages, with bars that are there twice, links across and guides that they do not need.
//
// z: the angle of the rising bars. Folded flat (sin 2 z = 0) a lift may go on in many ways: draws keep clear of it. A
// spring from below carries about all there is.
#pragma once

#include "catena/elements/constraints/slot.hpp"
#include "oracles/random_mechanism.hpp"

namespace catena::testing {

/// Stages of crossed bars, some of them twice, with more links across and a platform; a spring holds it up.
inline void scissor_lift(RandomMechanism& m) {
  const int stages = 1 + m.pick(3);
  const double length = m.size * m.uniform(0.7, 1.4);
  struct Bar {
    int stage;
    bool rising;  // from left below to right above
    double part;  // of the length, where the centroid lies
  };
  std::vector<Bar> bars;
  for (int k = 0; k < stages; ++k) {
    for (int n = m.pick(2) ? 2 : 1; n > 0; --n) {
      bars.push_back({k, true, m.uniform(0.3, 0.7)});
      bars.push_back({k, false, m.uniform(0.3, 0.7)});
      m.body(length);
      m.body(length);
    }
  }
  std::vector<int> links;  // stages with a link from the middle of their falling bar to that of the next one
  std::vector<double> fraction;
  for (int k = 0; k + 1 < stages; ++k) {
    if (m.pick(3) == 0) continue;
    links.push_back(k);
    fraction.push_back(m.uniform(0.2, 0.8));
    m.body(length / 2);
  }
  m.body(length);  // the platform
  const double shift = length * m.uniform(0.2, 0.6), height = length * m.uniform(0.05, 0.3);
  const double axis = m.axis;
  const Vec foot{m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)};
  // Right end of stage k's lower joints is at (L cos z, k L sin z), left at (0, k L sin z), in axes turned by `axis`.
  m.motion.places = [=](const JetCoordinates& z) {
    const Jet c = cos(z[0]), s = sin(z[0]);
    const Real L = length;
    std::vector<JetPlace> places;
    const auto put = [&](Jet x, Jet y, Jet angle) {
      const Real ca = std::cos(Real(axis)), sa = std::sin(Real(axis));
      places.push_back({fixed_point(foot) + JetPoint{ca * x - sa * y, sa * x + ca * y}, angle + Jet{axis}});
    };
    for (const Bar& bar : bars) {
      const Real part = bar.part;
      const Jet y = (L * (bar.stage + part)) * s;
      if (bar.rising) {
        put((L * part) * c, y, z[0]);
      } else {
        put((L * (1 - part)) * c, y, Jet{std::numbers::pi_v<Real>} - z[0]);
      }
    }
    for (std::size_t n = 0; n < links.size(); ++n) {
      // From (1 - f) middle + f left joint above, of stage k; along the rising bars, half as long: its middle.
      const Real f = fraction[n];
      put((L * (0.5L * (1 - f) + 0.25L)) * c, (L * (links[n] + 0.5L + 0.5L * f + 0.25L)) * s, z[0]);
    }
    put(Jet{shift}, (L * stages) * s + Jet{height}, {});
    return places;
  };
  m.motion.z[0] = m.uniform(0.5, 1.1);
  m.motion.rate[0] = m.some_rate(0.5);
  m.place_bodies();
  const double z = static_cast<double>(m.motion.z[0]);
  const auto at = [&](double x, double y) {
    return foot + rotated({length * x * std::cos(z), length * y * std::sin(z)}, axis);
  };
  const int platform = static_cast<int>(m.motion.model->bodies.size()) - 1;
  for (int b = 0; b < static_cast<int>(bars.size()); ++b) {
    const Bar& bar = bars[static_cast<std::size_t>(b)];
    const int k = bar.stage;
    // Its lower end, its middle and, at the top, its upper end: pinned to the first bar that has the place.
    const auto first_of = [&](int stage, bool rising) {
      int n = 0;
      while (bars[static_cast<std::size_t>(n)].stage != stage || bars[static_cast<std::size_t>(n)].rising != rising)
        ++n;
      return n;
    };
    const Vec low = at(bar.rising ? 0 : 1, k), high = at(bar.rising ? 1 : 0, k + 1), centre = at(0.5, k + 0.5);
    if (k == 0 && bar.rising) m.pin_at(ground, b, low);
    if (k == 0 && !bar.rising) {
      m.motion.model->add("", Slot<>{low, m.local_place(b, low), unit(axis)}, ground, b);
    }
    if (k > 0) m.pin_at(first_of(k - 1, !bar.rising), b, low);
    const int mate = first_of(k, true);
    if (b != mate) m.pin_at(mate, b, centre);
    if (b != first_of(k, bar.rising)) m.pin_at(first_of(k, bar.rising), b, high);
    // A guide on the left that the lift does not need.
    if (!bar.rising && m.pick(3) == 0) {
      m.motion.model->add("", Slot<>{foot, m.local_place(b, high), rotated({0, 1}, axis)}, ground, b);
    }
    if (k == stages - 1 && b == first_of(k, false)) m.pin_at(platform, b, high);
    if (k == stages - 1 && bar.rising) {
      m.motion.model->add("", Slot<>{m.local_place(platform, high), m.local_place(b, high), {1, 0}}, platform, b);
    }
  }
  for (std::size_t n = 0; n < links.size(); ++n) {
    const int b = static_cast<int>(bars.size() + n), k = links[n];
    const double f = fraction[n];
    int lower = 0, upper = 0;
    while (bars[static_cast<std::size_t>(lower)].stage != k || bars[static_cast<std::size_t>(lower)].rising) ++lower;
    while (bars[static_cast<std::size_t>(upper)].stage != k + 1 || bars[static_cast<std::size_t>(upper)].rising)
      ++upper;
    m.pin_at(lower, b, at(0.5 * (1 - f), k + 0.5 + 0.5 * f));
    m.pin_at(upper, b, at(0.5 * (1 - f) + 0.5, k + 1 + 0.5 * f));
  }
  // From the foot to the platform: it carries about all there is.
  double weight = 0;
  for (const BasicBody<double>& one : m.motion.model->bodies) weight += one.mass * 9.81;
  const Vec there = m.ground_place(platform, {});
  KnownSpring known{-1, platform, foot - rotated({0, m.size}, axis), {}, 0, 0, 0};
  const double span = norm(there - known.s_i);
  known.k = weight / span * m.uniform(1, 4);
  known.length = span + (m.weightless ? 0 : 0.6 * weight / known.k);
  if (m.pick(2)) known.c = known.k / m.motion.pace * m.uniform(0, 0.1);
  SpringDamper<> spring;
  spring.s_i = known.s_i;
  spring.k = known.k;
  spring.c = known.c;
  spring.length = known.length;
  m.motion.model->add_force("", spring, ground, platform);
  m.motion.springs.push_back(known);
  m.motion.flat = [](const Coordinates& q) { return std::sin(2 * q[0]); };
  m.motion.until = std::min(m.motion.until, 4 / m.motion.pace);
}

}  // namespace catena::testing
