// Certifies a stationary point as stable, unstable or neutral, by the true matrix of equilibrium without any shift.
//
//   K v = k W v on the null space of Phi_q,   W = (1, 1, radius^2):   k, N/m, the stiffness of mode v
//
// The number p of negative k comes from the inertia of one factorization (apps/manual/statics.md#certificate), whatever
// the size; the softest mode from a few Lanczos steps with its inverse. In both, constraint equations yield a little by
// the eps of the regularisation, which lowers every stiffness by eps mu^2, mu the reactions that the motion changes.
// Where that could decide the sign, the mode is projected to the null space by factors that do not contain K, and p is
// counted again by dense algebra. Where k then cannot be distinguished from rounding of its terms before they cancel
// (motion_groups.hpp), or |v^T K v| <= 1e-10 sum |v_i K_ij v_j|, the place itself being known no better, the point is
// neutral to second order: all motions that nothing resists are found (free_motions.hpp), and p counts the modes that
// are negative beside them.
// Source: Nour-Omid, Parlett, Ericsson, Jensen, Math. Comp. 48 (1987), for Lanczos with a singular metric.
#pragma once

#include <string>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

struct Certificate {
  bool valid = false;  ///< false: no factorization at all, or no solutions in numbers
  bool stable = false, neutral = false;
  int negative_modes = 0;
  double softest_stiffness = 0;          ///< lowest k; where there are negative ones, the most negative that was found
  std::vector<double> mode;              ///< its shape over columns, v^T W v = 1; empty where nothing can move
  int neutral_modes = 0;                 ///< motions that nothing resists to second order
  std::vector<std::string> free_bodies;  ///< that take part in them
  double curvature_floor = 0;            ///< a smaller |k| cannot be told from rounding, N/m
};

/// Certifies the point where the system is, with these multipliers: fills and factors the matrix, exact, unless its
/// numbers are those of the last factorization.
Certificate certify(StaticSystem& system, std::span<const double> lambda);

/// "body "rocker" turning" or "body "slider" along (1, 0)": the body that moves most in a mode, for messages.
std::string describe_mode(const Evaluator& evaluator, std::span<const double> mode, std::span<const double> radius);

}  // namespace catena
