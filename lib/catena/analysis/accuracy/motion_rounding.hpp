// The least errors of the columns of a motion, by their units: what the rounding of places does to the forces there.
//
//   F = max over coordinates of (forces + sum_j |K_cj| s_j)          N, moments over the length scale L
//   A = the same over the masses, and over L                        1/s^2
//
//   R = max(sqrt(A), largest rate of the motion, rad/s)
//   velocities eps L R,  accelerations eps L R^2,  forces eps F,  energies eps F L, ...
//
// forces, K, s_j: as in balance/static_accuracy.hpp; the rounding of a place, eps s, moves a mechanism as if it were an
// error of its start. It counts where nothing moves: there two runs have it in common. So does the rate: what holds a
// body solves for its velocity together with those of the others, of which it has the rounding. Without constraint
// forces, which answer to the others.
#pragma once

#include "catena/assembly/evaluate.hpp"
#include "catena/base/unit_kind.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class MotionRounding {
 public:
  /// At the place where the evaluator is.
  explicit MotionRounding(const Evaluator& evaluator);

  /// Takes over the largest rate of a motion, rad/s.
  void take_rate(double rate) { rate_ = rate; }

  /// Of a column of this kind; 0: nothing is known.
  double least_error(UnitKind unit) const;

 private:
  double length_, force_ = 0, square_ = 0, rate_ = 0;  // m, N, 1/s^2, rad/s
};

/// The fastest body of a row, in lengths `length` and rad a second.
double fastest_rate(const Snapshot& snapshot, double length);

}  // namespace catena
