// The choice of equations that are left out of a motion, where constraints always depend on each other (redundant
// constraints).
//
// Phi_q loses p ranks along the motion: w^T Phi_q = 0 for p independent w. ConstraintSolver leaves out p directions c
// among its equations, and its solution is exact as long as no combination of them is orthogonal to all w. The choice
// here keeps them as far from that case as a choice within single elements can: with the dual basis
//
//   W = (S + C)^-1 [c_1 ... c_p],   c_j^T w_k = (j = k),   rows counted by sqrt(S_rr)
//
// the volume |det c^T w| grows by the length of w_k at an element when c_k moves there, along w_k; this is repeated
// until no length exceeds 1.1 (a pivoted elimination whose pivots are blocks). It needs a factorization and p solves,
// at any place on the constraints. In exact arithmetic no result depends on the choice, so that a new one needs no
// restart; it is made when bodies have moved by 0.3 rad or length scales, or pivots have become half as large (both,
// where there are many directions).
//
// p is the rank deficiency at a place where the mechanism is not singular by accident: a start in a flat position shows
// too low a rank, so that the rank is also taken 0.1 rad along the drivers' or a free motion, and the larger one
// counts. A mechanism that is driven and starts in a singular position is no such place itself, and its drivers may
// rest there: the caller, which knows along which branch it starts, gives a place on that branch. Source: S. Goreinov,
// I. Oseledets et al., "How to find a good submatrix" (2010), with blocks as pivots.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {

class RedundantRows {
 public:
  /// How far away the rank is taken, rad or length scales: far enough that it is not that of a singular position nearby
  /// (sine 0.1), near enough to be assembled.
  static constexpr double probe_distance = 0.1;

  explicit RedundantRows(EquationsOfMotion& equations);

  /// A place of the motion, assembled at t, that is not singular.
  struct GenericPlace {
    double t = 0;
    std::vector<double> q;
  };
  /// Finds p and the directions, at q (assembled) and the evaluator's time; the equations are left without factors if
  /// there are any. `generic`: where the rank may be taken instead, if known; else it is looked for. Allocates.
  void find(std::span<const double> q, const GenericPlace* generic = nullptr);
  /// Goes on with directions that were chosen before, at q.
  void take_up(SparseVectors directions, std::span<const double> q);
  /// After a step to q, the place of the equations' factors: makes a new choice where one is needed.
  void follow(std::span<const double> q);
  /// The number of directions left out: p.
  int count() const { return equations_.left_out().count(); }
  /// Smallest pivot ratio that the motion will usually have, where it starts in a singular position; 0 elsewhere.
  double generic_ratio() const { return generic_ratio_; }
  /// How often directions were chosen.
  int choices() const { return choices_; }

 private:
  using Vector = std::vector<double>;
  std::vector<int> dependent_rows(std::span<const double> q);
  void leave_out(const std::vector<int>& rows);
  bool probe(std::span<const double> q, std::span<double> place);
  void choose();
  double moved(std::span<const double> q) const;

  EquationsOfMotion& equations_;
  const Plan& plan_;
  Vector chosen_at_;
  int choices_ = 0;
  double usual_ratio_ = 0;  // largest pivot ratio since the last choice
  double generic_ratio_ = 0;
};

}  // namespace catena
