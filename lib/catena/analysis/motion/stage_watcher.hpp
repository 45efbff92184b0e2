// Sees the stages of an integration while they are evaluated, with the factors of their equations at hand: what is
// carried along a motion then costs no evaluation of its own (sensitivity/motion_derivatives.hpp).
//
//   Y_s = y0 + h sum a_sj k_j,   k_s = f(t_s, Y_s),   s = 1 ... 11 of dormand_prince_8();  k_0 = f(from, y0)
//
// Only of steps whose stages are just these: no others are told of. A step that is rejected is followed by another
// trial from the same state; which trial was made shows at the end of the step. y = [q, qd], and maybe more, whole
// turns left out of angles.
#pragma once

#include <span>

#include "catena/analysis/motion/equations_of_motion.hpp"

namespace catena {

class StageWatcher {
 public:
  virtual ~StageWatcher() = default;
  /// A step is tried. False: its stages need not be shown.
  virtual bool begin_stages(double from, double to, std::span<const double> y) = 0;
  /// Stage s was evaluated: `equations` hold its factors and multipliers, `slope` is k_s.
  virtual void watch_stage(int s, double t, Side side, std::span<const double> y, std::span<const double> slope,
                           EquationsOfMotion& equations) = 0;
};

}  // namespace catena
