// Generalized coordinate partitioning (R. Wehage, E. Haug, J. Mech. Design 104 (1982)): the coordinates q are split
// into as many independent ones v as there are degrees of freedom, which are integrated, and dependent ones u, which
// follow:
//
//   Phi(u, v, t) = 0       by Newton's method from the integrator's estimate, v held
//   Phi_u du/dt = nu - Phi_v dv/dt
//
// Choice of v: rows of a basis of the tangent space (random motions, made tangent and orthonormal, lengths in the
// scene's length scale), picked by QR with pivoting, so that Phi_u is far from singular. It is made anew when the least
// pivot of Phi_u Phi_u^T, compared with the whole row, is below 0.3 of the largest since the choice was made: beside a
// flat position, where a motion may start, all choices have small ones.
// Singular case: where Phi_q loses rank no choice serves. The basis is dense: up to 500 degrees of freedom.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/assembly/systems/constraint_solver.hpp"

namespace catena {

class CoordinatePartition {
 public:
  /// Its tangents are a dense matrix, coordinates by freedoms: 8 MB with two thousand coordinates.
  static constexpr int most_freedoms = 500;

  explicit CoordinatePartition(EquationsOfMotion& equations);

  /// Chooses independent coordinates at q, which meets the constraints at the evaluator's time. False: a value is not
  /// finite, or there are more degrees of freedom than most_freedoms.
  bool choose(std::span<const double> q);
  /// Solves for the dependent positions and velocities; false where Newton's method does not converge or the choice is
  /// unusable.
  bool solve(double t, Side side, std::span<double> q, std::span<double> qd);
  /// Takes note that the motion has reached the place of the last solve(), and says whether the choice serves on.
  bool keeps_up() {
    largest_ratio_ = std::max(largest_ratio_, ratio_);
    return choices_ > 0 && ratio_ >= worse * largest_ratio_;
  }
  /// The mechanism moved without solve(): the choice must be made again.
  void forget() { ratio_ = 0; }
  int choices() const { return choices_; }
  double position_residual() const { return position_residual_; }

 private:
  // Pivots of dependent coordinates, as parts of the largest since the choice: errors of these are those of independent
  // ones over that part. Below the first, a step that was made is the last with this choice; below the second, where
  // they are fifty times as large, none is made.
  static constexpr double worse = 0.3, unusable = 0.02;
  void find_tangents(int freedoms);
  void pick_independent(int freedoms);
  void leave_out();
  bool factorize();
  bool residual_is_rounding(std::span<const double> q);

  EquationsOfMotion& equations_;
  Evaluator& evaluator_;
  const Plan& plan_;
  Scaling scaling_;
  ConstraintSolver system_;                // with lengths in length scales in place of masses
  std::vector<double> weight_, all_free_;  // by coordinate; zero holds a coordinate
  std::vector<double> row_square_;         // of a whole row, scaled
  std::vector<double> jacobian_, residual_, multipliers_, change_;
  std::vector<std::vector<double>> tangents_;  // by degree of freedom; scaled, by coordinate
  std::vector<double> mirror_;
  int freedoms_ = -1, choices_ = 0;
  double ratio_ = 1, largest_ratio_ = 1, position_residual_ = 0;  // the largest since the last choice
};

}  // namespace catena
