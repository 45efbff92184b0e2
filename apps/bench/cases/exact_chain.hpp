// Chains of uniform rods of 1 m and 1 kg in 64-bit-mantissa arithmetic: what the library's chains are compared with.
//
// Newton and Euler for each rod, F_k the force of rod k - 1 on rod k, u = (cos phi, sin phi), n = (-sin phi, cos phi),
// N = n n^T; equal accelerations at the pins make a block tridiagonal system:
//
//   a_k = F_k - F_k+1 + g      alpha_k = -6 n_k . (F_k + F_k+1)
//   (I + 3 N_0) F_0 + (3 N_0 - I) F_1 = -g - omega_0^2 u_0 / 2
//   (3 N_k-1 - I) F_k-1 + (2 I + 3 N_k + 3 N_k-1) F_k + (3 N_k - I) F_k+1 = -(omega_k^2 u_k + omega_k-1^2 u_k-1) / 2
//
// in angles alone: no code and no coordinates in common with the library. Motion: extrapolated midpoint rule of order
// 16. tests/bench holds it against data/reference/npendulum_N40.json. Source: Hairer, Norsett, Wanner, Solving Ordinary
// Differential Equations I, section II.9 (extrapolation).
#pragma once

#include <vector>

#include "catena/base/vec2.hpp"

namespace bench {

struct ExactChain {
  std::vector<long double> angle, rate;
  /// So many further rods at the end, level and falling freely: a straight tail moves along itself as one mass, M, and
  /// pulls at the last rod with F_n = (M / (M + 1) F_n-1,x, 0). Right as long as the last angle and rate are zero.
  int tail = 0;

  explicit ExactChain(int rods, long double start = 0)
      : angle(static_cast<std::size_t>(rods), start), rate(angle.size()) {}

  std::vector<long double> angular_accelerations() const;
  /// Of the far end of the last rod, m/s^2.
  catena::Vec2<long double> tip_acceleration() const;
  /// On by `duration` in so many steps.
  void move(long double duration, int steps);
  /// Far ends of all rods, m.
  std::vector<catena::Vec2<long double>> ends() const;

 private:
  std::vector<long double> solve(catena::Vec2<long double>& tip) const;
};

/// Far ends of the rods of a chain at rest of n rods of 1 m between pins `span` n apart, m: the tangents of their
/// angles rise evenly, at a rate that a bisection finds.
std::vector<catena::Vec2<long double>> ends_at_rest(int n, long double span);

}  // namespace bench
