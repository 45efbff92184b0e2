// Which one-sided elements hold at the end of one step of settling.
//
//   p >= 0,   Psi + Psi_q dq >= 0,   p (Psi + Psi_q dq) = 0       dq, lambda = -p: of the step with the closed ones as
//                                                                 equations and the open ones left out
//
// Gaps that would pull are opened and those that would overlap closed, all at once while that leads to new sets, then
// the first of them alone: the damping makes the matrix positive definite on the null space, for which that rule ends
// (K. Murty 1974). Units: m or rad, N or N m.
#pragma once

#include <set>
#include <span>
#include <vector>

#include "catena/analysis/statics/solvers/static_gaps.hpp"

namespace catena {

class SettlingGaps {
 public:
  /// All open; `tolerance`: of gaps and forces in the units of static_active_set.hpp.
  SettlingGaps(StaticSystem& system, ActiveSet& set, double tolerance);

  /// A step begins at q; `force`: N, that multipliers are compared with.
  void begin(std::span<const double> q, double force);
  /// Moves the system to q with the closed gaps as equations; the multipliers of the others become zero.
  void hold(std::span<const double> q, std::span<double> lambda) const;
  /// After a solution for the changes of q and lambda: changes the set by what it violates. False: nothing does.
  bool change(std::span<const double> lambda, std::span<const double> changes);
  /// Whether the last set was one that nothing violates.
  bool is_found() const { return found_; }

  /// The deepest overlap of an open gap where the system is, length scales or rad.
  double overlap() const;
  /// Whether no closed gap pulls and no open one overlaps where the system is.
  bool hold_all(std::span<const double> lambda) const;

 private:
  double enough() const;

  StaticSystem& system_;
  ActiveSet& set_;
  double tolerance_, force_ = 1;
  std::vector<double> gap_, jacobian_;  // at the beginning of the step, of all gaps
  std::set<std::vector<char>> tried_;
  int changes_ = 0;  // in this step
  bool found_ = false;
};

}  // namespace catena
