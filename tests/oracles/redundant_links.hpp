// Links in series whose joints are there two or three times, or whose bodies are welded together and tied besides; a
// block on two rails side by side.
//
// z: the angles of the links, or the way along the rails in sizes.
#pragma once

#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "oracles/random_mechanism.hpp"

namespace catena::testing {

/// One or two links in series, each of `parts` bodies that move as one.
struct Links {
  std::vector<int> link;             // of each body
  std::vector<Vec> centre;           // of each body, from its link's first pin
  std::vector<double> turn, length;  // of each body's frame; of each link
  Vec foot;
};
inline Links make_links(RandomMechanism& m, int parts) {
  Links l;
  l.foot = {m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)};
  const int links = 1 + m.pick(2);
  for (int k = 0; k < links; ++k) {
    l.length.push_back(m.size * m.uniform(0.5, 1.5));
    for (int p = 0; p < parts; ++p) {
      m.body(m.size);
      l.link.push_back(k);
      l.centre.push_back({m.size * m.uniform(0, 1.2), m.size * m.uniform(-0.5, 0.5)});
      l.turn.push_back(m.uniform(-3, 3));
    }
    m.motion.z[static_cast<std::size_t>(k)] = m.uniform(-3, 3);
    m.motion.rate[static_cast<std::size_t>(k)] = m.some_rate(2);
  }
  m.motion.freedoms = links;
  m.motion.until = std::min(m.motion.until, (links == 1 ? 8 : 4) / m.motion.pace);
  m.motion.places = [l](const JetCoordinates& z) {
    std::vector<JetPlace> places;
    for (std::size_t b = 0; b < l.link.size(); ++b) {
      const std::size_t k = static_cast<std::size_t>(l.link[b]);
      JetPoint pin = fixed_point(l.foot);
      if (k > 0) pin = pin + turned(z[0], {l.length[0], 0});
      places.push_back({pin + turned(z[k], l.centre[b]), z[k] + Jet{l.turn[b]}});
    }
    return places;
  };
  m.place_bodies();
  return l;
}
inline Vec joint_of(const RandomMechanism& m, const Links& l, int k) {
  return k == 0 ? l.foot : l.foot + l.length[0] * unit(static_cast<double>(m.motion.z[0]));
}
inline void welded_pairs(RandomMechanism& m) {
  const Links l = make_links(m, 2);
  for (int k = 0; k < m.motion.freedoms; ++k) {
    const int a = 2 * k, b = a + 1;
    const Vec joint = joint_of(m, l, k);
    const int held = a + m.pick(2), holder = k == 0 ? ground : m.pick(2);
    m.pin_at(holder, held, joint);
    const Vec place = joint + m.size * Vec{m.uniform(-1, 1), m.uniform(-1, 1)};
    m.motion.model->add("", Weld<>{m.local_place(a, place), m.local_place(b, place)}, a, b);
    for (int n = 1 + m.pick(3); n > 0; --n) {
      const Vec s{m.size * m.uniform(-1, 1), m.size * m.uniform(-1, 1)};
      const Vec other = m.ground_place(a, s) + m.size * m.uniform(0.3, 1.5) * unit(m.uniform(-3, 3));
      const int what = m.pick(4);
      if (what == 0) {
        m.motion.model->add("", RelativeAngle<>{}, a, b);
      } else if (what == 1) {
        m.motion.model->add("", RelativeDistance<>{s, m.local_place(b, other)}, a, b);
      } else {
        m.motion.model->add("", Coupler<>{s, m.local_place(b, other)}, a, b);
      }
    }
  }
  m.add_springs();
}
inline void doubled_joints(RandomMechanism& m) {
  const Links l = make_links(m, 1);
  for (int k = 0; k < m.motion.freedoms; ++k) {
    for (int n = k == 0 ? 2 : 1 + m.pick(3); n > 0; --n) m.pin_at(k == 0 ? ground : k - 1, k, joint_of(m, l, k));
  }
  m.add_springs();
}
/// A body that hangs on a massless link, two or three times the same.
inline void doubled_coupler(RandomMechanism& m) {
  const double length = m.size * m.uniform(0.5, 1.5);
  const Vec foot{m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)},
      arm = m.size * m.uniform(0.2, 0.8) * unit(m.uniform(-3, 3));
  m.body(m.size);
  m.motion.freedoms = 2;
  m.motion.places = [=](const JetCoordinates& z) {
    return std::vector<JetPlace>{{fixed_point(foot) + turned(z[0], {length, 0}) - turned(z[1], arm), z[1]}};
  };
  m.motion.z = {m.uniform(-3, 3), m.uniform(-3, 3)};
  m.motion.rate = {m.some_rate(2), m.some_rate(2)};
  m.motion.until = std::min(m.motion.until, 4 / m.motion.pace);
  m.place_bodies();
  for (int n = 2 + m.pick(2); n > 0; --n) {
    if (m.pick(2)) {
      m.motion.model->add("", Coupler<>{foot, arm}, ground, 0);
    } else {
      m.motion.model->add("", AbsoluteDistance<>{arm, foot}, 0, ground);
    }
  }
  m.add_springs();
}
/// A block on two rails side by side, or with its angle held besides.
inline void block_on_guides(RandomMechanism& m) {
  const double slope = m.uniform(-3, 3), turn = m.uniform(-3, 3);
  const Vec start{m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)}, along = unit(slope);
  const double size = m.size;
  m.body(m.size);
  m.motion.places = [=](const JetCoordinates& z) {
    return std::vector<JetPlace>{
        {{Jet{start.x} + Real(size * along.x) * z[0], Jet{start.y} + Real(size * along.y) * z[0]}, {turn}}};
  };
  m.motion.z[0] = m.uniform(-1, 1);
  m.motion.rate[0] = m.some_rate(1);
  m.motion.until = std::min(m.motion.until, 4 / m.motion.pace);
  m.place_bodies();
  for (int n = 2; n > 0; --n) {
    const Vec at = m.ground_place(0, {}) + m.size * Vec{m.uniform(-1, 1), m.uniform(-1, 1)};
    if (n == 2 || m.pick(2)) {
      m.motion.model->add("", Translational<>{at, m.local_place(0, at), along, rotated(along, -turn)}, ground, 0);
    } else {
      m.motion.model->add("", Slot<>{at, m.local_place(0, at), along}, ground, 0);
      m.motion.model->add("", AbsoluteAngle<>{}, 0);
    }
  }
  m.add_springs();
}

}  // namespace catena::testing
