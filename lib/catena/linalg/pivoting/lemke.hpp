// Linear complementarity by pivots (Lemke's method).
//
//   w = M z + q,   w >= 0,  z >= 0,  w_i z_i = 0 for every i
//
// A multiple z_0 of a positive vector d is added to w until all of it is positive; pivots between w and z, each the
// complement of what left before, take z_0 away again. Where M is copositive plus, as that of contacts at rest with
// friction is (z^T M z >= 0 for z >= 0), the pivots end at a solution or on a ray where there is none. d has entries
// between one and two without a pattern, so that equal rows do not tie. M may be singular. Dense: some n to 2 n pivots
// of n^2 operations each. Units: rows and columns of M are expected to be of size one.
// Source: Cottle, Pang and Stone, The Linear Complementarity Problem (1992), section 4.4; Stewart and Trinkle, An
// implicit time-stepping scheme for rigid body dynamics with inelastic collisions and Coulomb friction (1996).
#pragma once

#include <span>

namespace catena {

/// Finds z; M row by row. False: the pivots end on a ray, or do not end within a multiple of n.
bool lemke(std::span<const double> M, std::span<const double> q, std::span<double> z);

}  // namespace catena
