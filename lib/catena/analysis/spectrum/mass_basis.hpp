// Bases of the motions that constraints allow, orthonormal in the masses.
//
//   Z^T M Z = I,   Phi_q Z = 0        M = diag(m, m, J), kg and kg m^2
//
// In two steps: groups whose coordinates all have mass are orthonormal in M from the start (MotionGroups::
// orthonormalise with basis_weights); in the others coordinates count as lengths, and the QR decomposition of M^1/2 Z
// makes them so. Singular where a motion moves no mass at all. Source: as motion_groups.hpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/spectrum/motion_groups.hpp"

namespace catena {

/// Weights for MotionGroups::orthonormalise: the masses of a group in which all coordinates have some, else the square
/// of an arm each. `mass`: per column.
std::vector<double> basis_weights(StaticSystem& system, const MotionGroups& groups, std::span<const double> mass);

/// Makes a basis that is orthonormal in those weights orthonormal in M. Nothing, or a column of the motion that moves
/// no mass: then there is no such basis.
std::optional<int> use_masses(StaticSystem& system, MotionGroup& group, std::span<const double> mass);

}  // namespace catena
