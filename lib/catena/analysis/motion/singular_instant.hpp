// Accelerations and loads of a motion at an instant at which its constraints depend on each other.
//
// There w^T Phi_q = 0 for some w, and the equations of motion no longer determine the accelerations: their formal
// solution is not the limit of the motion from either side. But w^T Phi = 0 holds along the motion, and its third
// derivative (its second is w^T gamma = 0) brings the missing equations,
//
//   w^T (Phi_q qdddot + 3 Phi_q' qdd - gamma') = 0,   b qdd = w^T gamma' / 3,   b = w^T Phi_q'
//
// Phi_q' and gamma' the derivatives along the straight line (q + e qd, t + e). The multipliers' part along w grows like
// 1/(t - t*) where Phi_q^T w vanishes; their product is a load b^T beta, so that
//
//   M qdd + Phi_q^T lambda + b^T beta = Q
//
// Where constraints always depend on each other, and at rest, b adds no equation. Singular: where w^T gamma does not
// vanish (accelerations grow without bound): no answer. Dense algebra, for up to `most_rows` rows.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {

class SingularInstant {
 public:
  /// The decomposition of so many rows takes some seconds.
  static constexpr int most_rows = 1200;

  explicit SingularInstant(EquationsOfMotion& equations) : equations_(equations) {}

  enum class Outcome {
    found,
    always_dependent,  ///< constraints depend on each other along the motion, too; or there is none, at rest
    not_found,
  };
  /// Finds the accelerations at (t, q, qd), of plan.coordinates() entries, where the equations were last solved: the
  /// forces of then are taken, with those of contacts. The evaluator is left at t and q. Allocates.
  Outcome solve(double t, std::span<const double> q, std::span<const double> qd, std::span<double> qdd);
  /// The load of the constraints with bounded multipliers, Q - M qdd - b^T beta, by coordinate.
  std::span<const double> loads() const { return loads_; }
  /// The time over which derivatives were taken, s: in it bodies move by 1e-5 rad or length scales.
  double moment() const { return moment_; }
  /// Whether multipliers grow without bound towards the instant, by a load that is not rounding.
  bool unbounded() const { return unbounded_; }

 private:
  EquationsOfMotion& equations_;
  std::vector<double> loads_;
  double moment_ = 0;
  bool unbounded_ = false;
};

}  // namespace catena
