// How light bodies are to turn, whatever the unit of length.
//
//   max over bodies of  (sum_r Phi_r,phi^2 / J) / (sum_r (Phi_rx^2 + Phi_ry^2) / m) = max m a^2 / J
//
// a, m: root mean square of the levers at which rows that also shift the body turn it. Where this is large the inverse
// of J dominates the diagonal of Phi_q M^-1 Phi_q^T, and the masses are rounded off beside it. Rows in radians, and
// bodies without mass or inertia, say nothing. Units: m kg, J kg m^2. 0: no body has such a row. Linear time.
#pragma once

#include <span>

#include "catena/assembly/plan.hpp"

namespace catena {

/// `masses`: by coordinate, 3 plan.moving, zero where massless; `jacobian`: values of Phi_q.
double largest_turn(const Plan& plan, std::span<const double> masses, std::span<const double> jacobian);

}  // namespace catena
