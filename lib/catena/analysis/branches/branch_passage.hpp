// The search for the configuration q_s at which one combination w of the constraints loses its gradient, and what is
// known there: c, lambda and e of branch_keeping.hpp. Equations of drivers are left out: branches of a mechanism meet
// where its other constraints lose rank, whoever moves it. Small dense matrices.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {

/// Where branches pass each other.
struct BranchCorner {
  double offset = 0, rounding = 0;  ///< |c|, and what it may be off by
  double gap = 0;                   ///< sqrt(2 |c| / |lambda|), rad or length scales
  std::vector<double> direction;    ///< e by column, per m and rad of it
};

enum class BranchMeeting {
  none,
  corner,    ///< they pass each other
  crossing,  ///< they cross, to rounding
  several,   ///< not known: several combinations are near to losing their gradients at once
};

/// Newton's method from q, which is left at q_s; `place`: one of the motion beside the passage, whose size rounding
/// follows. `corner`: where it is one. phi, values: for rows, entries of Phi_q. The evaluator is left elsewhere.
BranchMeeting find_branch_meeting(EquationsOfMotion& equations, std::span<double> q, std::span<const double> place,
                                  std::span<double> phi, std::span<double> values, BranchCorner& corner);

}  // namespace catena
