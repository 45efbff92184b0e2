// The instants at which a motion is singular, located on the bridge that interpolates it (kinematics_bridge.hpp).
//
// Along the bridge the smallest pivots of the blocks are smooth, without the rounding that Newton's method suffers near
// a singular matrix: the instant at which one vanishes, with or without a change of its sign, is found to some 1e-13 of
// the bridge. Units: s.
#pragma once

#include <vector>

#include "catena/analysis/kinematics/course/kinematics_bridge.hpp"
#include "catena/analysis/kinematics/driven_solver.hpp"

namespace catena {

class BridgeSearch {
 public:
  /// Samples on a bridge: 0.05 rad or length scales apart, as it is 0.4 long at most (kinematics_march.cpp).
  static constexpr int samples = 9;

  /// From one instant of the bridge to a later one. All must outlive this object.
  BridgeSearch(Evaluator& evaluator, DrivenSolver& solver, const MotionBridge& bridge, double from, double to)
      : evaluator_(evaluator),
        solver_(solver),
        bridge_(bridge),
        from_(from),
        to_(to),
        q_(static_cast<std::size_t>(evaluator.plan().coordinates())) {}

  /// All that are singular, ascending: looked for between `samples` instants.
  std::vector<double> singular_instants();
  /// Moves t, a singular instant, to the one nearby at which the drivers rest. False: they do not rest, and t stays.
  bool find_rest(double& t);

 private:
  bool margins_at(double t, std::vector<BlockMargin>& margins);
  double refine_instant(std::size_t block, double a, double b);

  Evaluator& evaluator_;
  DrivenSolver& solver_;
  const MotionBridge& bridge_;
  double from_, to_;
  std::vector<double> q_;
};

}  // namespace catena
