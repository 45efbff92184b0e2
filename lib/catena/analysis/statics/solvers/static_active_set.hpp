// Shared by the searches with gaps: the units in which gaps and their forces are compared, and how their sets change.
//
// A gap counts in a length L or in radians, its force in F or F L, F a force that is typical of the mechanism, N.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/analysis/statics/solvers/static_gaps.hpp"

namespace catena {

struct GapUnits {
  double gap = 1, force = 1;
};

/// Gaps change all at once while that leads to new sets, up to the second number; then one by one, up to the first.
inline constexpr int most_sets = 200, most_sets_at_once = 15;

/// Of a gap's row, from L and F: 1 rad and F L against angles.
inline GapUnits units_of(const StaticSystem& system, int row, const GapUnits& scale) {
  const bool angle = system.plan().row_is_angle[static_cast<std::size_t>(row)] != 0;
  return angle ? GapUnits{1, scale.force * scale.gap} : scale;
}

/// The largest dead load (springs may carry any force during the iteration); without loads, the force of the stiffest
/// spring at one thousandth of a length scale; without springs, 1 N.
double typical_force(StaticSystem& system);

/// For every gap, in these units at the system's place, by how much it violates its state: the pull of a closed one,
/// the overlap of an open one; negative where it does not.
std::vector<double> gap_faults(StaticSystem& system, std::span<const double> lambda, std::span<const char> closed);

/// Marks what touches without a force where the system is, which is an equilibrium with the closed ones as equations.
void mark_weak(StaticSystem& system, std::span<const double> lambda, ActiveSet& set);

}  // namespace catena
