// The order in which Phi_q of a mechanism is eliminated in lanes: chosen once, the same for all designs.
//
// Phi_q falls into diagonal blocks (block triangular form, the last one is solved first). In a block every entry that
// is +1 or -1 whatever the design is a pivot that cannot vanish: they are eliminated first, that of least fill-in
// before others. What is left, the tail, is a small dense matrix: its determinant is that of the block, up to its sign,
// and vanishes where the block is singular. Products of constants are formed here, once. Pivots of right-hand sides are
// divided by in the same way. The transposed equations are solved by the same steps, transposed, in the opposite order.
//
// Steps that do the same stand together as far as their order allows: a step goes to the last run of its kind unless a
// later run writes what it needs, or needs what it writes. Additions and changes of sign are products with constants,
// of whichever kind has a run that takes them.
#pragma once

#include <string>
#include <vector>

#include "catena/analysis/batch/kernels/lane_code.hpp"
#include "catena/assembly/plan.hpp"

namespace catena {

struct LaneElimination {
  std::vector<LaneStep> step;
  std::vector<LaneRun> factor, solve, transposed;
  std::vector<LaneReset> reset;
  std::vector<LaneTail> tail;
  std::vector<LaneUnknown> unknown;
  std::vector<double> initial;  ///< of every slot: constants, else zero
  int lengths = 0;              ///< of the unknowns

  /// `varying`: slots that elements write; `constant`: the value of every other slot of the plan. False, with the
  /// reason, where the equations do not determine the coordinates, or a tail exceeds largest_tail.
  bool choose(const Plan& plan, const Model& model, const std::vector<int>& varying, std::vector<double> constant,
              std::string& why_not);
};

}  // namespace catena
