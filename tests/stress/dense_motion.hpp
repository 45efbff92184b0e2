// The motion of a random mechanism by its dense formulation, and by how much an error of its start grows meanwhile.
#pragma once

#include "stress/random_scene.hpp"

namespace catena::testing {

/// Positions and velocities at the instants; empty where the oracle itself gives up.
inline std::vector<Vector> dense_motion(const RandomScene& random, const Vector& v0,
                                        const std::vector<double>& instants) {
  const DenseMechanism& dense = random.dense;
  const Eigen::Index n = dense.size();
  const auto kept = dense.independent_rows(0, random.q);
  const auto slope = [&](Real t, const Vector& y) {
    Vector rate(2 * n);
    rate << y.tail(n), acceleration(dense, kept, t, y.head(n), y.tail(n));
    return rate;
  };
  Vector y(2 * n), scale(2 * n);
  y << random.q, v0;
  for (Eigen::Index k = 0; k < n; ++k) {
    scale[k] = k % 3 == 2 ? 1 : Real(random.size);
    scale[n + k] = scale[k] * Real(random.pace);
  }
  Extrapolation motion(slope, y, scale, 0.02L / random.pace, 1e-14L);
  std::vector<Vector> at;
  for (const double t : instants) {
    if (!motion.go_to(t, 400)) return {};
    at.push_back(motion.y());
  }
  // Redundant rows that stay met are no mistake of this formulation; others are.
  const Vector zero = Vector::Zero(n);
  const auto start = dense.residuals(0, random.q, zero, zero);
  const auto now = dense.residuals(instants.back(), at.back().head(n), zero, zero);
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (std::abs(std::remainder((now[k].f - start[k].f) / Real(random.size), 2 * std::acos(Real(-1)))) > 1e-10L)
      return {};
  }
  return at;
}

/// By how much an error of the start is multiplied until the end, relative to sizes.
inline double growth(const RandomScene& random, const std::vector<double>& instants, const Vector& end) {
  constexpr Real small = 1e-7L;
  const Matrix basis = random.motions();
  double most = 1;
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    const std::vector<Vector> moved =
        dense_motion(random, random.v + small * Real(random.pace * random.size) * basis.col(k), instants);
    if (moved.empty()) return 1e300;
    for (Eigen::Index c = 0; c < random.dense.size(); ++c) {
      const Real scale = c % 3 == 2 ? 1 : Real(random.size);
      most = std::max(most, double(std::abs(moved.back()[c] - end[c]) / scale / small));
    }
  }
  return most;
}

}  // namespace catena::testing
