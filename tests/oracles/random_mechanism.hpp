// A random mechanism in the making, whose motion is known (known_motion.hpp): its scale, and the draws that all kinds
// of redundant_mechanisms.hpp and massless_mechanisms.hpp share.
//
// A kind is a function that draws bodies, says where they are as functions of few coordinates, places them, and only
// then adds joints between places of the plane, so that they fit to rounding. Lengths come in `size`, masses in `mass`,
// rates in `motion.pace`, 1/s: that of a pendulum of that size. Mechanisms with an axis are turned by `axis`, rad.
#pragma once

#include <numbers>
#include <random>

#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/known_motion.hpp"

namespace catena::testing {

using Vec = Vec2<double>;

inline Vec unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
inline Vec rotated(Vec s, double angle) {
  const double c = std::cos(angle), w = std::sin(angle);
  return {c * s.x - w * s.y, w * s.x + c * s.y};
}

class RandomMechanism {
 public:
  explicit RandomMechanism(unsigned seed) : random_(seed) {}

  KnownMotion motion;
  double size = 1, mass = 1, axis = 0;
  bool weightless = false;

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  double some_mass() { return mass * std::pow(10.0, uniform(-1, 1)); }
  double some_rate(double most) { return uniform(-most, most) * motion.pace; }
  /// Between a thousandth and a thousand times the size of the rest.
  double some_radius() { return size * std::pow(10.0, uniform(-3, 3)); }

  /// A new body with a radius of gyration of at most two thirds of `reach`; its pose is set by place_bodies().
  int body(double reach) { return add_body(some_mass(), reach, 0.05); }
  /// Its numbers are drawn like those of others.
  int massless_body(double reach) { return add_body(0, reach, 0.1); }
  /// One beside massless ones: no thinner than a rod.
  int body_beside_massless(double reach) { return add_body(some_mass(), reach, 0.1); }

  /// Gives all bodies their places and velocities at the start. Joints are added after.
  void place_bodies() {
    const std::vector<JetPlace> places = motion.places_of(motion.z, motion.rate);
    for (std::size_t b = 0; b < places.size(); ++b) {
      BasicBody<double>& body = motion.model->bodies[b];
      const JetPlace& p = places[b];
      body.position = {static_cast<double>(p.r.x.f), static_cast<double>(p.r.y.f)};
      body.angle = static_cast<double>(p.phi.f);
      body.velocity = {static_cast<double>(p.r.x.d), static_cast<double>(p.r.y.d)};
      body.angular_velocity = static_cast<double>(p.phi.d);
      body.velocity_given = body.angular_velocity_given = true;
    }
  }
  Vec ground_place(int b, Vec s) const {
    const BasicBody<double>& body = motion.model->bodies[static_cast<std::size_t>(b)];
    return body.position + rotated(s, body.angle);
  }
  Vec local_place(int b, Vec p) const {
    const BasicBody<double>& body = motion.model->bodies[static_cast<std::size_t>(b)];
    return rotated(p - body.position, -body.angle);
  }
  void pin(int i, Vec s_i, int j, Vec s_j) { motion.model->add("", Revolute<>{s_i, s_j}, i, j); }
  /// A pin between two bodies (i may be the ground) at a place in the ground frame.
  void pin_at(int i, int j, Vec at) { pin(i, i < 0 ? at : local_place(i, at), j, local_place(j, at)); }
  /// A spring to the mechanism and to what its motion is computed from.
  void add_spring(const KnownSpring& known) {
    SpringDamper<> spring;
    spring.s_i = known.s_i;
    spring.s_j = known.s_j;
    spring.k = known.k;
    spring.c = known.c;
    spring.length = known.length;
    motion.model->add_force("", spring, known.i, known.j);
    motion.springs.push_back(known);
  }
  void add_springs();

 private:
  int add_body(double mass_of_body, double reach, double thinnest) {
    return motion.model->add_body(
        "b" + std::to_string(motion.model->bodies.size()),
        {.mass = mass_of_body, .inertia = mass_of_body * reach * reach * uniform(thinnest, 0.4)});
  }

  std::mt19937 random_;
};

/// Springs and dampers, now and then, as strong as weights; from the ground to some bodies.
inline void RandomMechanism::add_springs() {
  const int bodies = static_cast<int>(motion.model->bodies.size());
  double weight = 0;
  for (const BasicBody<double>& body : motion.model->bodies) weight += body.mass * 9.81;
  for (int k = pick(3); k > 0; --k) {
    const int b = pick(bodies);
    KnownSpring known{-1,
                      b,
                      ground_place(b, {}) + uniform(1.5, 5) * size * unit(uniform(-3, 3)),
                      {uniform(-0.3, 0.3) * size, uniform(-0.3, 0.3) * size},
                      weight / size * uniform(0.1, 1),
                      pick(2) ? 0 : weight / size / motion.pace * uniform(0, 0.3),
                      size * uniform(0.3, 2)};
    add_spring(known);
  }
  if (pick(3) == 0) {
    const int b = pick(bodies);
    const double k = weight * size * uniform(0, 0.5);
    KnownTorsion known{b, k, pick(2) ? 0 : k / motion.pace * uniform(0, 0.3), uniform(-2, 2),
                       pick(2) ? 0 : weight * size * uniform(-0.3, 0.3)};
    TorsionSpring<> spring;
    spring.k = known.k;
    spring.c = known.c;
    spring.angle = known.angle;
    // n = k (phi - angle) + c phid + N turns j by -n.
    motion.model->add_force("", spring, ground, b, {TimeFunction<double>(-known.torque)});
    motion.torsions.push_back(known);
  }
}

}  // namespace catena::testing
