// Bars on two to six parallel cranks or couplers: all but two of them are redundant. z: the angle of the cranks.
//
// With all anchors on a line, or two cranks, the mechanism passes flat positions, in which one more equation becomes
// dependent and another motion possible: `flat` vanishes there.
#pragma once

#include "catena/elements/constraints/coupler.hpp"
#include "oracles/random_mechanism.hpp"

namespace catena::testing {

/// Anchors of cranks, relative to the first: on a line, or anywhere.
inline std::vector<Vec> anchors(RandomMechanism& m, int count, bool on_line) {
  std::vector<Vec> at{{0, 0}};
  for (int k = 1; k < count; ++k) {
    at.push_back({at.back().x + m.size * m.uniform(0.5, 1.5), on_line ? 0 : m.size * m.uniform(-0.6, 0.6)});
  }
  for (Vec& a : at) a = rotated(a, m.axis);
  return at;
}

/// Cranks of one length on a bar, which translates.
inline void bar_on_cranks(RandomMechanism& m) {
  const int cranks = 2 + m.pick(5);
  const bool on_line = m.pick(2) == 0, doubled = m.pick(4) == 0;
  const double length = m.size * m.uniform(0.5, 1.5), tilt = m.uniform(-1, 1);
  const Vec first{m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)};
  const std::vector<Vec> anchor = anchors(m, cranks, on_line);
  std::vector<Vec> centre;   // of a crank, from its pin, along it and across
  std::vector<double> turn;  // of a crank's frame against it
  for (int k = 0; k < cranks; ++k) {
    m.body(length);
    const bool plain = m.pick(2) == 0;
    centre.push_back(plain ? Vec{length / 2, 0} : Vec{length * m.uniform(0, 1), length * m.uniform(-0.3, 0.3)});
    turn.push_back(plain ? 0 : m.uniform(-3, 3));
  }
  m.body(2 * m.size);
  const Vec bar_centre = {m.size * m.uniform(-1, 2), m.size * m.uniform(-0.5, 0.5)};  // from the first crank's end
  m.motion.places = [=](const JetCoordinates& z) {
    std::vector<JetPlace> places;
    for (std::size_t k = 0; k < centre.size(); ++k) {
      places.push_back({fixed_point(first + anchor[k]) + turned(z[0], centre[k]), z[0] + Jet{turn[k]}});
    }
    places.push_back({fixed_point(first + bar_centre) + turned(z[0], {length, 0}), {tilt}});
    return places;
  };
  const double axis = m.axis;
  // Two cranks lie flat along the line through their anchors.
  const Vec line = anchor[1];
  if (on_line || cranks == 2) {
    const double along = std::atan2(line.y, line.x);
    m.motion.flat = [along](const Coordinates& z) { return std::sin(z[0] - along); };
  }
  m.motion.z[0] = axis + m.uniform(-3, 3);
  m.motion.rate[0] = m.some_rate(3);
  m.place_bodies();
  for (int k = 0; k < cranks; ++k) {
    const Vec foot = first + anchor[static_cast<std::size_t>(k)];
    const Vec end = foot + length * unit(static_cast<double>(m.motion.z[0]));
    for (int n = 0; n < (doubled && m.pick(2) ? 2 : 1); ++n) m.pin_at(ground, k, foot);
    for (int n = 0; n < (doubled && m.pick(2) ? 2 : 1); ++n) m.pin_at(k, cranks, end);
  }
  m.add_springs();
}

/// A bar on massless couplers of one length.
inline void bar_on_couplers(RandomMechanism& m) {
  const int couplers = 2 + m.pick(5);
  const bool on_line = m.pick(2) == 0;
  const double length = m.size * m.uniform(0.5, 1.5), tilt = m.uniform(-1, 1);
  const Vec first{m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)};
  const std::vector<Vec> anchor = anchors(m, couplers, on_line);
  m.body(2 * m.size);
  const Vec bar_centre = {m.size * m.uniform(-1, 2), m.size * m.uniform(-0.5, 0.5)};
  m.motion.places = [=](const JetCoordinates& z) {
    return std::vector<JetPlace>{{fixed_point(first + bar_centre) + turned(z[0], {length, 0}), {tilt}}};
  };
  if (on_line || couplers == 2) {
    const double along = std::atan2(anchor[1].y, anchor[1].x);
    m.motion.flat = [along](const Coordinates& z) { return std::sin(z[0] - along); };
  }
  m.motion.z[0] = m.axis + m.uniform(-3, 3);
  m.motion.rate[0] = m.some_rate(3);
  m.place_bodies();
  for (const Vec& a : anchor) {
    const Vec foot = first + a, end = foot + length * unit(static_cast<double>(m.motion.z[0]));
    m.motion.model->add("", Coupler<>{foot, m.local_place(0, end)}, ground, 0);
  }
  m.add_springs();
}

}  // namespace catena::testing
