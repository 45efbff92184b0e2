// Trusses of pinned rods with more diagonals than hold them, moved as one rigid body: on a pin, or in flight.
//
// z: the angle of the truss; in flight its place besides, in sizes. A pin at a node of several rods is one joint for
// each rod beyond the first.
#pragma once

#include "oracles/random_mechanism.hpp"

namespace catena::testing {

/// Rods of a truss: pins at nodes, diagonals both ways.
struct Rod {
  int from, to;
  double part;  // of the length, where the centroid lies
};
struct Truss {
  std::vector<Vec> node;  // from the truss's own origin
  std::vector<Rod> rods;
};
inline Truss make_truss(RandomMechanism& m) {
  Truss t;
  const int panels = 1 + m.pick(3);
  const double width = m.size * m.uniform(0.5, 1.2), height = m.size * m.uniform(0.5, 1.2);
  for (int k = 0; k <= panels; ++k) {
    for (int up = 0; up < 2; ++up) {
      t.node.push_back({k * width + 0.1 * m.size * m.uniform(-1, 1), up * height + 0.1 * m.size * m.uniform(-1, 1)});
    }
  }
  const auto rod = [&](int a, int b) {
    t.rods.push_back({a, b, m.pick(2) ? 0.5 : m.uniform(0.2, 0.8)});
    m.body(norm(t.node[static_cast<std::size_t>(b)] - t.node[static_cast<std::size_t>(a)]));
  };
  rod(0, 1);
  const int overbraced = m.pick(panels);
  for (int k = 0; k < panels; ++k) {
    const int a = 2 * k;
    rod(a, a + 2);
    rod(a + 1, a + 3);
    rod(a + 2, a + 3);
    const bool both = k == overbraced || m.pick(2) == 0, up = m.pick(2) == 0;
    if (both || up) rod(a, a + 3);
    if (both || !up) rod(a + 1, a + 2);
  }
  return t;
}
/// Places of the rods when the truss's origin is at `origin` and the truss turned by `angle`.
inline std::vector<JetPlace> places_of_rods(const Truss& t, JetPoint origin, Jet angle) {
  std::vector<JetPlace> places;
  for (const Rod& rod : t.rods) {
    const Vec a = t.node[static_cast<std::size_t>(rod.from)], b = t.node[static_cast<std::size_t>(rod.to)];
    const double along = std::atan2(b.y - a.y, b.x - a.x);
    places.push_back({origin + turned(angle, a + rod.part * (b - a)), angle + Jet{along}});
  }
  return places;
}
inline void pin_rods(RandomMechanism& m, const Truss& t, Vec origin, double angle) {
  for (int n = 0; n < static_cast<int>(t.node.size()); ++n) {
    const Vec at = origin + rotated(t.node[static_cast<std::size_t>(n)], angle);
    int first = -1;
    for (int r = 0; r < static_cast<int>(t.rods.size()); ++r) {
      const Rod& rod = t.rods[static_cast<std::size_t>(r)];
      if (rod.from != n && rod.to != n) continue;
      if (first >= 0) m.pin_at(first, r, at);
      if (first < 0) first = r;
    }
  }
}
inline void swinging_truss(RandomMechanism& m) {
  const Truss t = make_truss(m);
  const int held = m.pick(static_cast<int>(t.node.size()));
  const Vec foot{m.size * m.uniform(-2, 2), m.size * m.uniform(-2, 2)}, arm = t.node[static_cast<std::size_t>(held)];
  m.motion.places = [=](const JetCoordinates& z) {
    return places_of_rods(t, fixed_point(foot) - turned(z[0], arm), z[0]);
  };
  m.motion.z[0] = m.uniform(-3, 3);
  m.motion.rate[0] = m.some_rate(2);
  m.place_bodies();
  const double angle = static_cast<double>(m.motion.z[0]);
  pin_rods(m, t, foot - rotated(arm, angle), angle);
  const bool all = m.pick(2) == 0;
  bool pinned = false;
  for (int r = 0; r < static_cast<int>(t.rods.size()); ++r) {
    const Rod& rod = t.rods[static_cast<std::size_t>(r)];
    if ((rod.from != held && rod.to != held) || (pinned && !all)) continue;
    m.pin_at(ground, r, foot);
    pinned = true;
  }
  m.add_springs();
}
inline void flying_truss(RandomMechanism& m) {
  const Truss t = make_truss(m);
  const double size = m.size;
  m.motion.freedoms = 3;
  m.motion.places = [=](const JetCoordinates& z) {
    return places_of_rods(t, {Real(size) * z[1], Real(size) * z[2]}, z[0]);
  };
  m.motion.z = {m.uniform(-3, 3), m.uniform(-2, 2), m.uniform(-2, 2)};
  m.motion.rate = {m.some_rate(2), m.some_rate(2), m.some_rate(2)};
  m.motion.until = std::min(m.motion.until, 4 / m.motion.pace);
  m.place_bodies();
  pin_rods(m, t, {size * static_cast<double>(m.motion.z[1]), size * static_cast<double>(m.motion.z[2])},
           static_cast<double>(m.motion.z[0]));
  if (m.pick(2)) m.add_springs();
}

}  // namespace catena::testing
