// Small motions under forces without a potential (circulatory ones): eigenvalues of an unsymmetric pencil.
//
//   Z^T K Z y = omega2 y,   v = Z y,   Z^T M Z = I        K = -dQ/dq + sum lambda Phi_qq, unsymmetric
//
// omega2 < 0: divergence. A pair omega2 +- i b: flutter, oscillations at Re sqrt(omega2 + i b) that grow and fade by
// |Im sqrt(omega2 + i b)|. All eigenvalues by the real Schur form; each, and each pair, is then refined on its own
// right and left invariant subspace X, Y with the sparse K,
//
//   B = (Y^T X)^-1 Y^T K X        wrong by the product of the errors of X and Y only; rounding r / sigma(Y^T X)
//
// with r of StiffnessFloor. Two equal omega2 that rounding may have made a pair, (b11 - b22)^2 / 4 + b12 b21 no further
// below zero than rounding of B, count as real; omega2 below r / |y^T x| as zero. 1/s^2; vectors over columns. Without
// masses the metric is that of lengths: signs of real values are right, pairs mean nothing. Singular: where vectors of
// X depend on each other, a disturbance of the size of its rounding is added to the matrix. Source: G. Golub, C. Van
// Loan, Matrix Computations, 4th ed., sections 7.1 and 7.2; H. Ziegler, Principles of Structural Stability, 1968.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/balance/static_tangent.hpp"
#include "catena/analysis/spectrum/motion_groups.hpp"

namespace catena {

/// One real value, or a pair omega2 +- i imaginary.
struct CirculatoryMode {
  double omega2 = 0, imaginary = 0;
  /// v^H M v = 1; of a pair the real and the imaginary part of the vector of the one that grows, omega2 - i imaginary:
  /// Re (v e^(growth t + i frequency t)). The decisive component of the shape is positive, of the imaginary part zero.
  std::vector<double> shape, quadrature;

  bool is_pair() const { return imaginary > 0; }
  double frequency() const;  ///< Re sqrt(omega2 + i imaginary), rad/s
  double growth() const;     ///< its imaginary part, 1/s
};

struct CirculatoryModes {
  std::vector<CirculatoryMode> modes;        ///< ascending in omega2
  int negative = 0, pairs = 0, neutral = 0;  ///< real ones below zero, pairs, zeros
  bool symmetric = false;                    ///< K is, but for rounding

  bool stable() const { return negative == 0 && pairs == 0 && neutral == 0; }
};

/// The motions that constraints allow at one configuration.
class CirculatoryMotions {
 public:
  /// At the configuration where the system is. `mass`: per column; empty: lengths. `tangent` is filled by find().
  CirculatoryMotions(StaticSystem& system, StaticTangent& tangent, std::span<const double> mass);

  int freedoms() const { return groups_.freedoms(); }
  /// Whether dense algebra is affordable.
  bool are_small() const { return groups_.are_small(); }
  /// A column of a motion that moves no mass: then find() must not be called.
  std::optional<int> massless_column() const { return massless_; }
  /// With the forces of the configuration where the system is, whose Phi_q is that of the constructor. `residual`, N:
  /// what is left unbalanced. False where the values did not settle: numbers that are not finite.
  bool find(std::span<const double> lambda, double residual, CirculatoryModes& modes);

  static constexpr int most_freedoms = MotionGroups::usual_freedoms;

 private:
  class Refinement;

  StaticSystem& system_;
  StaticTangent& tangent_;
  MotionGroups groups_;
  std::optional<int> massless_;
};

/// The motions in the masses of the bodies or, where one has none or a motion moves none, in lengths; then `lack` says
/// which. At the configuration where the system is.
std::unique_ptr<CirculatoryMotions> motions_in_masses(StaticSystem& system, StaticTangent& tangent, std::string& lack);

}  // namespace catena
