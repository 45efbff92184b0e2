// The accuracy of a balance of forces at a point: compared with the forces themselves, and with the rounding that they
// contain.
//
//   r = V_q + Phi_q^T lambda          moments divided by the body's radius, so that all are N
//   forces_c = sum of |terms of r_c|: every element's force, gravity, every constraint's part
//   rounding_c = 4 eps (forces_c + sum over elements, j of |K_cj| s_j)
//
// K an element's stiffness, of constraints lambda Phi_qq, s_j the size of the numbers from which its places are formed
// (m; 1 rad and the angle): a place is known to eps s, so that the force of a spring of k N/m is known to eps k s at
// best. A point is balanced if max |r| <= tolerance x max forces_c, and balanced to rounding if at every coordinate
// |r_c| is within that or rounding_c; where there are no loads and all forces are rounding, r is compared with the
// largest rounding_c that constraints transmit. Neither is accepted where the residual is a visible part of the loads
// (`shown`): forces of springs under prestress, or the rounding of very stiff ones, may be larger than the loads that
// they carry. Source: Higham, Accuracy and Stability of Numerical Algorithms, section 3.1 (running error).
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

struct StaticAccuracy {
  /// A residual above this part of the loads changes the third digit of some force: not an equilibrium.
  static constexpr double shown = 1e-3;

  double residual = 0;  ///< N, largest
  double forces = 0;    ///< N, largest sum of terms at one coordinate
  double loads = 0;     ///< N, the same of gravity, forces and torques alone; of all where there are none
  double rounding = 0;  ///< N, where the residual is furthest beyond it; 0 where it was not needed
  int column = -1;      ///< where the residual is largest
  bool balanced = false, rounded = false;

  bool holds() const { return balanced || rounded; }
};

/// rounding_c of the balance at the point where the system is, by columns, N or N m. The work of one evaluation of all
/// stiffnesses.
std::vector<double> balance_rounding(StaticSystem& system, std::span<const double> lambda);

/// Judges the point where the system is. The work of one evaluation; of all stiffnesses too where not balanced.
StaticAccuracy judge_balance(StaticSystem& system, std::span<const double> lambda, double tolerance);

}  // namespace catena
