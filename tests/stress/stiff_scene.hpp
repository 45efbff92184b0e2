// Random mechanisms with stiff, damped bushings and springs, 1e2 ... 1e10 times as stiff as their weights ask for,
// stiff dampers and light bodies; and their motion by a dense formulation in long double.
#pragma once

#include "stress/dense_motion.hpp"
#include "stress/implicit_extrapolation.hpp"

namespace catena::testing {

inline void make_light(RandomScene& random, int body, double part) {
  DenseMechanism::Body& dense = random.dense.bodies[static_cast<std::size_t>(body)];
  Json& entry = random.scene["bodies"]["b" + std::to_string(body)];
  for (const char* key : {"mass", "inertia"}) entry[key] = entry[key].get<double>() * part;
  dense = {entry["mass"].get<double>(), entry["inertia"].get<double>()};
}

/// Sets it moving as well. Springs damp their vibration within a few of its periods: else it would have to be followed.
inline void make_stiff(RandomScene& random) {
  const int bodies = static_cast<int>(random.dense.bodies.size()), count = 1 + random.pick(3);
  const double weight = 9.81 * double(random.dense.bodies[0].mass) / random.size;
  if (random.pick(2) == 0) {
    const int body = random.pick(bodies);
    make_light(random, body, std::pow(10.0, -random.uniform(1, 6)));
  }
  for (int k = 0; k < count; ++k) {
    const int j = random.pick(bodies), i = random.pick(bodies + 1) - 1;
    double mass = double(random.dense.bodies[static_cast<std::size_t>(j)].mass);
    if (i >= 0) mass = std::min(mass, double(random.dense.bodies[static_cast<std::size_t>(i)].mass));
    const double stiffness = weight * std::pow(10.0, random.uniform(2, 10)), part = random.uniform(0.3, 3);
    const int kind = random.pick(4);
    if (kind == 0) {
      random.add_relaxed(i, j, 0, stiffness / random.pace * std::pow(10.0, -random.uniform(1, 3)), true);
    } else {
      random.add_relaxed(i, j, stiffness, 2 * part * std::sqrt(stiffness * mass), kind != 1);
    }
  }
  random.set_moving();
}

/// Calls each(k, q, v, a) at the instants; false where the oracle gives up.
template <class Each>
bool follow_stiff_motion(const RandomScene& random, const Vector& v0, const std::vector<double>& instants,
                         Real tolerance, Each&& each) {
  const auto kept = random.dense.independent_rows(0, random.q);
  const Eigen::Index n = random.dense.size();
  Vector scale(2 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    scale[k] = k % 3 == 2 ? 1 : Real(random.size);
    scale[n + k] = scale[k] * Real(random.pace);
  }
  const auto slope = [&](Real t, const Vector& q, const Vector& v) {
    return acceleration(random.dense, kept, t, q, v);
  };
  ImplicitExtrapolation motion(slope, random.q, v0, scale, 1e-6L / random.pace, tolerance);
  for (std::size_t k = 0; k < instants.size(); ++k) {
    if (!motion.go_to(instants[k], 200)) return false;
    each(k, motion.q(), motion.v(), slope(instants[k], motion.q(), motion.v()));
  }
  return true;
}

}  // namespace catena::testing
