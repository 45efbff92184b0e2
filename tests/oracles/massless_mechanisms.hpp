// Random mechanisms with massless bodies whose motion is known (known_motion.hpp): wheels, links, trolleys and idlers
// of any size beside what has mass, and the mechanisms of redundant_mechanisms.hpp with some of their bodies massless.
//
// Sizes 1e-6 ... 1e6 m; wheels a thousandth to a thousand times as large as the rest.
#pragma once

#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"
#include "oracles/redundant_mechanisms.hpp"

namespace catena::testing {

/// From the ground to a body, about as strong as its weight.
inline void add_spring_to(RandomMechanism& m, int b, Vec foot) {
  const double k = m.motion.model->bodies[static_cast<std::size_t>(b)].mass * 9.81 / m.size * m.uniform(0.1, 3);
  m.add_spring({-1, b, foot, {}, k, m.pick(2) ? 0 : k / m.motion.pace * m.uniform(0, 0.3), m.size * m.uniform(0.3, 2)});
}

/// A block on a table and a weight that hangs from it, by racks on a massless wheel; or the block alone, pushed.
inline void wheel_between_racks(RandomMechanism& m) {
  const double radius = m.some_radius(), size = m.size;
  const bool hangs = m.pick(2);
  m.massless_body(1);
  m.body_beside_massless(m.size);
  if (hangs) m.body_beside_massless(m.size);
  m.motion.places = [=](const JetCoordinates& z) {
    // The block moves by size z to the left; the wheel turns with it counter-clockwise.
    const Jet way = Real(size) * z[0];
    std::vector<JetPlace> places = {{{Jet{}, Jet{}}, (1 / Real(radius)) * way}};
    places.push_back({{Jet{Real(size)} - way, Jet{Real(radius)}}, Jet{}});
    if (hangs) places.push_back({{Jet{-Real(radius)}, Jet{} - way}, Jet{}});
    return places;
  };
  m.motion.rate[0] = m.uniform(-1, 1) * m.motion.pace;
  m.place_bodies();
  Model& model = *m.motion.model;
  model.add("", Revolute<>{}, ground, 0);
  model.add("", AbsoluteAngle<>{}, 1);
  RackPinion<> rack;
  rack.axis_i = {1, 0};
  rack.radius = radius;
  rack.side = -1;
  model.add("", rack, 1, 0);
  if (hangs) {
    model.add("", AbsoluteAngle<>{}, 2);
    rack.axis_i = {0, 1};
    model.add("", rack, 2, 0);
  } else {
    add_spring_to(m, 1, {-3 * m.size, radius + m.size});
  }
}
/// Crank and slider of any masses, their connecting rod massless, longer than the crank.
inline void slider_crank(RandomMechanism& m) {
  const double crank = m.size * m.uniform(0.3, 1), rod = crank * std::pow(10.0, m.uniform(0.1, 3)),
               part = m.uniform(0, 1);
  const double turn = m.uniform(-3, 3);
  m.body_beside_massless(crank);
  m.massless_body(rod);
  m.body_beside_massless(crank);
  m.motion.places = [=](const JetCoordinates& z) {
    const Real l = rod;
    const JetPoint pin = turned(z[0], {crank, 0});
    const Jet across = (1 / l) * pin.y, along = sqrt(Jet{1} - across * across);
    // The rod's direction is (along, -across); its frame is turned besides.
    const Jet angle{-std::asin(across.f), -across.d / along.f,
                    -(across.dd + across.d * across.d * across.f / (along.f * along.f)) / along.f};
    return std::vector<JetPlace>{{turned(z[0], {crank / 2, 0}), z[0]},
                                 {pin + JetPoint{Real(part) * l * along, Real(-part) * l * across}, angle + Jet{turn}},
                                 {{pin.x + l * along, Jet{}}, Jet{}}};
  };
  m.motion.z[0] = m.uniform(-3, 3);
  m.motion.rate[0] = m.uniform(1, 3) * m.motion.pace;
  m.place_bodies();
  Model& model = *m.motion.model;
  const auto local = [&](Vec s) {
    const double c = std::cos(turn), w = std::sin(turn);
    return Vec{c * s.x + w * s.y, -w * s.x + c * s.y};
  };
  model.add("", Revolute<>{{0, 0}, {-crank / 2, 0}}, ground, 0);
  model.add("", Revolute<>{{crank / 2, 0}, local({-part * rod, 0})}, 0, 1);
  model.add("", Revolute<>{local({(1 - part) * rod, 0}), {0, 0}}, 1, 2);
  model.add("", Translational<>{{0, 0}, {0, 0}, {1, 0}, {1, 0}}, ground, 2);
}

/// A body that swings under a massless trolley on a rail.
inline void trolley(RandomMechanism& m) {
  const double arm = m.size * m.uniform(0.3, 1.5), size = m.size;
  m.massless_body(1);
  m.body_beside_massless(m.size * m.uniform(0.5, 2));
  m.motion.freedoms = 2;
  m.motion.places = [=](const JetCoordinates& z) {
    const JetPoint pin{Real(size) * z[1], Jet{}};
    return std::vector<JetPlace>{{pin, Jet{}}, {pin + turned(z[0], {arm, 0}), z[0]}};
  };
  m.motion.z = {m.uniform(-3, 3), 0};
  m.motion.rate = {m.uniform(-2, 2) * m.motion.pace, m.uniform(-1, 1) * m.motion.pace};
  m.place_bodies();
  m.motion.model->add("", Translational<>{{0, 0}, {0, 0}, {1, 0}, {1, 0}}, ground, 0);
  m.motion.model->add("", Revolute<>{{0, 0}, {-arm, 0}}, 0, 1);
}

/// Two wheels with masses off their axles, and massless ones in between, in mesh or by belts.
inline void idler(RandomMechanism& m) {
  const int idlers = 1 + m.pick(3), wheels = idlers + 2;
  std::vector<double> radius, start;
  std::vector<Vec> off;
  std::vector<Real> ratio{1};
  std::vector<bool> belt;
  double x = 0;
  std::vector<double> axle;
  for (int k = 0; k < wheels; ++k) {
    const bool massless = k > 0 && k < wheels - 1;
    radius.push_back(massless ? m.some_radius() : m.size * m.uniform(0.3, 1));
    massless ? m.massless_body(radius.back()) : m.body_beside_massless(radius.back());
    start.push_back(m.uniform(-3, 3));
    off.push_back(massless ? Vec{} : Vec{radius.back() * m.uniform(-0.5, 0.5), radius.back() * m.uniform(-0.5, 0.5)});
    if (k > 0) {
      belt.push_back(m.pick(2));
      x += belt.back() ? 1.5 * (radius[static_cast<std::size_t>(k) - 1] + radius.back())
                       : radius[static_cast<std::size_t>(k) - 1] + radius.back();
      ratio.push_back((belt.back() ? 1 : -1) * ratio.back() * Real(radius[static_cast<std::size_t>(k) - 1]) /
                      Real(radius.back()));
    }
    axle.push_back(x);
  }
  m.motion.places = [=](const JetCoordinates& z) {
    std::vector<JetPlace> places;
    for (std::size_t k = 0; k < axle.size(); ++k) {
      const Jet angle = ratio[k] * z[0] + Jet{start[k]};
      places.push_back({fixed_point({axle[k], 0}) + turned(angle, off[k]), angle});
    }
    return places;
  };
  m.motion.rate[0] = m.uniform(-2, 2) * m.motion.pace;
  m.place_bodies();
  Model& model = *m.motion.model;
  for (int k = 0; k < wheels; ++k) {
    const std::size_t n = static_cast<std::size_t>(k);
    model.add("", Revolute<>{{axle[n], 0}, -1 * off[n]}, ground, k);
    if (k == 0) continue;
    if (belt[n - 1]) {
      Belt<> joint;
      joint.s_i = -1 * off[n - 1];
      joint.s_j = -1 * off[n];
      joint.radius_i = radius[n - 1];
      joint.radius_j = radius[n];
      model.add("", joint, k - 1, k);
    } else {
      Gear<> joint;
      joint.s_i = -1 * off[n - 1];
      joint.s_j = -1 * off[n];
      joint.radius_i = radius[n - 1];
      joint.radius_j = radius[n];
      model.add("", joint, k - 1, k);
    }
  }
}

inline constexpr MechanismKind massless_kinds[] = {{"wheel between racks", wheel_between_racks},
                                                   {"link of a slider-crank", slider_crank},
                                                   {"trolley", trolley},
                                                   {"idler of a train", idler}};
inline constexpr int number_of_massless_kinds = static_cast<int>(std::size(massless_kinds));

inline KnownMotion massless_motion(int kind, unsigned seed) {
  RandomMechanism m(seed * 151u + static_cast<unsigned>(kind));
  m.size = std::pow(10.0, m.uniform(-6, 6));
  m.mass = std::pow(10.0, m.uniform(-3, 3));
  m.motion.kind = massless_kinds[kind].name;
  m.motion.length = m.size;
  m.motion.pace = std::sqrt(9.81 / m.size);
  m.motion.model->gravity = {0, -9.81};
  m.motion.until = m.uniform(0.5, 2) / m.motion.pace;
  massless_kinds[kind].make(m);
  return m.motion;
}

/// Kinds of redundant_mechanisms.hpp whose bodies may be massless: all but the body on one link, a point mass of which
/// flies freely until it is stretched.
inline constexpr int massless_variants[] = {0, 1, 2, 3, 4, 5, 7, 8, 9, 10};
inline constexpr int all_massless_kinds = number_of_massless_kinds + static_cast<int>(std::size(massless_variants));

/// The motion of the same mechanism with some bodies massless, or without inertia; false: too little mass would be left
/// there or in other positions.
inline bool make_some_massless(KnownMotion& motion, unsigned seed) {
  std::mt19937 random(seed);
  const KnownMotion before = motion;
  auto model = std::make_shared<Model>(*motion.model);
  int changed = 0;
  for (BasicBody<double>& body : model->bodies) {
    const unsigned what = random() % 6;
    if (what > 2) continue;
    ++changed;
    if (what != 2) body.inertia = 0;
    if (what != 1) body.mass = 0;
  }
  motion.model = model;
  constexpr int places = 100;
  for (int k = 0; k < places; ++k) {
    Coordinates z = motion.z;
    for (Real& value : z) value += Real(random() % 1000) / 1000 * 2 * std::numbers::pi_v<Real> * (k > 0);
    if (!(motion.constrained_mass(z) > 1e-3L * before.constrained_mass(z))) return false;
  }
  return changed > 0;
}

}  // namespace catena::testing
