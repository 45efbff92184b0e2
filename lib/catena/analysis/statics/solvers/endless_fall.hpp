// Whether an energy falls along a straight line for ever.
//
//   Phi(q + s v) = 0,   Psi(q + s v) >= 0,   V(q + s v) = V(q) - F s,   F > 0
//   for all s > 0; v over columns, m and rad; Psi the gaps of one-sided elements
//
// Tried out at distances that double as far as numbers reach: what begins to hold anywhere shows beyond that place, by
// an energy that differs from F s. v is known as well as motions without stiffness are told (free_motions.hpp): so much
// of v^T |K| v s^2 / 2 may be stretched across the line, and so much of s^2, in extents, may rows miss. Singular: none;
// a line that ends in a hollow narrower than its distance, and a guide bent by less, may pass for what has no end.
#pragma once

#include <span>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

/// Whether V falls by F s along a direction (columns) from q without end, F > 0; the system is left at q, with the
/// stiffnesses that its matrix holds.
bool falls_for_ever(StaticSystem& system, std::span<const double> q, std::span<const double> direction);

}  // namespace catena
