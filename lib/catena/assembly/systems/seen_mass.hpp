// The mass that a massless coordinate c moves with, seen through single rows of constraints:
//
//   r_c = max over rows r of  Phi_rc^2 / sum_k Phi_rk^2 / m_k        k: coordinates that have a mass, or were seen
//   before
//
// It is a first guess for the small masses that replace zero ones: the mass that resists c through equation r alone if
// nothing else moves. The constrained mass itself may be less (other equations, positions near a dead centre), so that
// callers check the result. Coordinates are reached equation by equation, first from coordinates with mass, then from
// those already reached; r_c has the unit of the coordinate's mass (kg, kg m^2) and scales with the scene; x and y of a
// body get the larger of both. 0: no equation leads there. Linear time.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/plan.hpp"

namespace catena {

/// `masses`: by coordinate, 3 plan.moving, zero where massless; `jacobian`: values of Phi_q. Zero for all coordinates
/// that have mass. Allocates.
std::vector<double> seen_masses(const Plan& plan, std::span<const double> masses, std::span<const double> jacobian);

}  // namespace catena
