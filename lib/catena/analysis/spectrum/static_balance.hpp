// The forces at a given configuration: it is assembled, and the multipliers that balance its loads best are computed.
//
//   min |V_q + Phi_q^T lambda|   in the weights (1, 1, radius^2)^-1
//
// At an equilibrium the residual is zero; elsewhere it is the force that would set the mechanism in motion. Where
// constraints depend on each other the least multipliers in the same sense are taken. One factorization. N, N m.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/base/status.hpp"

namespace catena {

/// Assembles q (plan order) unless it meets the constraints already, and moves the system there.
Report assemble_for_statics(StaticSystem& system, std::vector<double>& q);

/// Residual forces below this part of the largest force count as none.
inline constexpr double negligible_part = 1e-7;

/// The unbalanced force: the largest one, N, also relative to the largest force in the mechanism, and where.
struct Imbalance {
  double force = 0, relative = 0;
  int column = -1;      ///< where it is largest
  double rounding = 0;  ///< N, what rounding of the places makes of stiff springs
  /// Small beside the forces, or rounding.
  bool negligible() const;
};

/// Fills lambda (rows).
Imbalance balance_loads(StaticSystem& system, std::span<double> lambda);

}  // namespace catena
