// Whether a step has left its branch where two branches nearly meet.
//
// Near a configuration q_s at which one combination of the constraints loses its gradient, w^T Phi_q = 0, what the
// others allow, q = q_s + Z x, meets that combination where
//
//   c + 1/2 x^T H x = 0,   c = w^T Phi(q_s),   H = Z^T (w^T Phi_qq) Z
//
// c = 0: branches cross there, and a motion goes straight on. c != 0: branches pass each other at the distance
// sqrt(2 |c| / |lambda|), and a motion turns from the direction of one asymptote into that of the other. A step that is
// longer than that may go straight on and end on the other branch, which meets the constraints as well: no estimate of
// the step's error shows it. Where H has one eigenvalue lambda of the sign of -c, the two parts are told apart by the
// sign of x along its eigenvector e: a step between x of different signs has left its branch.
//
// q_s is found by Newton's method from the middle of the passage; lengths in length scales, rows of length one, without
// those that always depend on others. Where c is no larger than its rounding it counts as zero. Where rounding changes
// c by more than 5e-4 of itself no step can follow the turn; such a step is reported as `left_within_rounding`.
// Equations of drivers are left out: branches meet where the others lose rank. Not judged, but reported: several
// combinations at once, more than `most_rows` rows. Vectors of coordinates and rows are kept from one passage to the
// next; small dense matrices are made for each step that passes beside a singular position. Source:
// apps/manual/numerics.md#singular-passages.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {

class BranchKeeping {
 public:
  /// Whether steps of such a mechanism can be judged at all.
  static bool judges(const EquationsOfMotion& equations) {
    const Plan& plan = equations.plan();
    return plan.rows > 0 && plan.rows <= most_rows;
  }
  explicit BranchKeeping(const EquationsOfMotion& equations);

  enum class Course {
    kept,
    left,                  ///< the step went straight on where its branch turns
    left_within_rounding,  ///< the same, nearer to the other branch than rounding lets steps turn
    crossed,               ///< it went straight on where branches cross, to rounding
    unjudged,              ///< several combinations are near to losing their gradients
  };
  /// What a step from q0 to q1 (size coordinates()) at the evaluator's time did; `middle`: about where it passes. The
  /// evaluator is left elsewhere, the factors of the equations as they are.
  Course course(EquationsOfMotion& equations, std::span<const double> q0, std::span<const double> q1,
                std::span<const double> middle);
  /// The distance between branches that pass each other near q, where it is so small that steps can hardly turn; 0
  /// where there are none such. The evaluator is left elsewhere.
  double narrow_gap(EquationsOfMotion& equations, std::span<const double> q);
  /// The distance between the two branches that the last judged step passed, rad or length scales.
  double gap() const { return gap_; }

 private:
  // The eigenvalues of so many rows take some milliseconds, once a step beside a singular position.
  static constexpr int most_rows = 120;
  double gap_ = 0;
  std::vector<double> q_, phi_, values_;  // of the search: its place, rows, entries of Phi_q
};

}  // namespace catena
