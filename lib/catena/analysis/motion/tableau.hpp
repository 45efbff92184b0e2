// Coefficients of the explicit Runge-Kutta methods of Dormand and Prince.
//
//   k_i = f(t + c_i h, y + h sum_j a_ij k_j)        y(t + h) = y + h sum_i b_i k_i        error estimates sum_i e_i k_i
//
// Order 8 with embedded orders 5 and 3 (12 stages) and three further stages for an interpolant of order 7; order 5 with
// an embedded order 4 (7 stages, the last one at the new point). Sources: E. Hairer, S. Norsett, G. Wanner, "Solving
// Ordinary Differential Equations I", 2nd ed., sections II.5, II.6 and the program DOP853 by E. Hairer and G. Wanner;
// J. Dormand, P. Prince, J. Comp. Appl. Math. 6 (1980).
#pragma once

#include <array>

namespace catena {

/// A weighted sum of stages: only those that count.
struct StageTerm {
  int stage;
  double weight;
};

struct StageSum {
  std::array<StageTerm, 12> term{};
  int count = 0;

  const StageTerm* begin() const { return term.data(); }
  const StageTerm* end() const { return term.data() + count; }
};

struct Tableau {
  int order = 0;
  int stages = 0;                       ///< evaluated to make a step
  std::array<double, 16> c{};           ///< of the stages, and of those for the interpolant after them
  std::array<StageSum, 16> a{};         ///< a[i]: what stage i is evaluated from
  StageSum b;                           ///< the step
  StageSum error;                       ///< the error estimate; of order 5 for the method of order 8
  StageSum error_low;                   ///< of order 3 for the method of order 8
  std::array<StageSum, 4> interpolant;  ///< the four highest coefficients of the interpolant of the method of order 8
};

/// The stage at the new point: number 12 of order 8 (only for the interpolant), number 6 of order 5.
const Tableau& dormand_prince_8();
const Tableau& dormand_prince_5();

}  // namespace catena
