// What the kernels of equilibria in lanes compute from, beside lane_code.hpp: one group of designs at rest, each at its
// own configuration.
//
//   D = diag(1, 1, 1/r)      K = D (V_qq + sum lambda Phi_qq) D      A = Phi_q D      A^T = Q [R; 0]
//   B = Q^T K Q, its last rows and columns those of the null space of Phi_q: shifted, L L^T there
//
// Steps solve [K + s, A^T; A, 0] [d; lambda] = [-D V_q; -Phi], s a shift in N/m of all K: the orthogonal Q of
// Householder needs no exchange of rows, so that lanes never part, and its null space has the metric (1, 1, r^2) in
// which stiffnesses are told. Dense: for small plans. Units: N, N m, N/m, m, rad, J.
// Source: Golub and Van Loan, Matrix Computations, sections 5.2 and 6.2; Nocedal and Wright, section 16.2.
#pragma once

#include "catena/analysis/batch/kernels/lane_code.hpp"

namespace catena {

/// Of a configuration, one number a lane each.
enum LaneRest {
  rest_energy,    ///< potential energy
  rest_gap,       ///< largest residual of Phi, rad or length scales
  rest_extent,    ///< of the coordinates, as StaticSystem::extent()
  rest_load,      ///< largest applied force, moments by the radius
  rest_dead,      ///< largest weight, force or torque that is no spring's
  rest_residual,  ///< of V_q + Phi_q^T lambda
  rest_force,     ///< largest force in the mechanism
  rest_stiffest,  ///< largest |K_cc|
  rest_rank,      ///< least part of a row of A that the rows before it do not span
  rest_positive,  ///< 1 where K + s is positive on the null space, else 0
  rest_pivot,     ///< smallest pivot of L L^T, by size
  rest_softest,   ///< a lower bound of the softest stiffness on the null space
  rest_step,      ///< largest entry of a step, rad or length scales
  rest_turn,      ///< its largest angle
  rest_travel,    ///< its largest length
  rest_slope,     ///< V_q^T change
  rest_terms,     ///< sum |K_ij d_i d_j|
  rest_numbers
};

struct LaneStaticJob {
  LaneJob equations;  ///< q: where the mechanism is; right: Phi there; matrix: Phi_q
  int columns, entries;
  const int *entry_row, *entry_column;  ///< of the numbers of `matrix`
  // By lane:
  const double* inverse_arm;  ///< D, columns
  const double* origin;       ///< of the coordinates of moving bodies, two each
  const double* length;       ///< scale
  const double* mask;         ///< 1 where reflect() and correct() change something
  const double* shift;        ///< s
  const double* by_weights;   ///< 1 where corrections leave K out: the factors are those of A alone
  double* gradient;           ///< V_q, columns
  double *change, *next_lambda;
  double *stiffness, *reduced;            ///< K, B
  double *reflector, *factor, *diagonal;  ///< of Householder with R above it; rows; of R
  double *lower, *work;                   ///< L; 2 columns
  double* told;                           ///< rest_numbers
};

struct LaneStaticKernels {
  /// Phi, Phi_q, V_q, energy, gap, extent, load, dead.
  void (*look)(const LaneStaticJob&);
  /// Residual and force of `lambda`.
  void (*weigh)(const LaneStaticJob&);
  /// Q and R, rank; where the mask is 1.
  void (*reflect)(const LaneStaticJob&);
  /// The multipliers that balance V_q best, by Q and R, into `lambda`.
  void (*balance)(const LaneStaticJob&);
  /// K and B with `lambda`, stiffest; after reflect().
  void (*curve)(const LaneStaticJob&);
  /// L, positive, pivot.
  void (*stiffen)(const LaneStaticJob&);
  /// Change and next multipliers, step, turn, travel, slope, terms.
  void (*step)(const LaneStaticJob&);
  /// q += the step that meets Phi = 0 to first order, angles turned by 1 rad at most, where the mask is 1; step.
  void (*correct)(const LaneStaticJob&);
  /// Softest.
  void (*soften)(const LaneStaticJob&);
};

}  // namespace catena
