// A driven mechanism that is given in a singular position: whether its motion can start there, and along which branch.
//
// One rule for every analysis that moves it:
//
//   drivers ask for a velocity that cannot be, or none goes on     `lock_up`
//   drivers rest, and never move                                   `singular`: no branch can be chosen
//   several branches, none chosen                                  `bifurcation`, with their list
//   one branch, or the one chosen                                  the motion starts along it
//
// Conditions of branches: branches.hpp. Where the drivers rest they are looked at again a little later.
#pragma once

#include "catena/analysis/pose/branches.hpp"

namespace catena {

struct SingularStart {
  Report report;
  SingularPoint point;
  int branch = 0;  ///< from 1: the tangent along which the motion starts
};

/// `point`: of find_branches at the evaluator's time, with dependence::follows_at_start; `branch`: the one asked for, 0
/// if none was; `direction`: 1 or -1, of time; `choose`: what the author can do to choose a branch. The evaluator is
/// left at point.t.
SingularStart decide_start(Evaluator& evaluator, SingularPoint point, int branch, double direction,
                           std::string_view choose = "choose one with \"branch\"");

/// The largest rate of a tangent, 1/s, with lengths in length scales; of one at rest, for a driver of speed 1.
double rate_of(const Evaluator& evaluator, std::span<const double> tangent);

}  // namespace catena
