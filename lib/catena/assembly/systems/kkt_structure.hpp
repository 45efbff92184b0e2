// The pattern of the matrix of static equilibrium and the slot of every value in it, made once from the plan.
//
//   [ K + Phi_q^T R Phi_q   Phi_q^T ]      K = V_qq + sum lambda Phi_qq, R = diag(rho) > 0, E = diag(eps) > 0
//   [ Phi_q                 -E      ]      rows 0 ... columns - 1: coordinates; then the constraint rows
//
// Phi_q^T R Phi_q changes no solution of the equations with E = 0 but gives every body pivots that are not zero: K
// alone has zero blocks (a hanging rod contributes only its stiffness against turning). Elimination order: bodies by
// minimum degree in the graph of bodies that share an element, every constraint row directly after the last of its
// bodies. Joints before their bodies would divide by eps; joints after all bodies would fill the matrix. Source:
// apps/manual/numerics.md#matrix-of-equilibrium; Golub and Greif, SIAM J. Sci. Comput. 24 (2003), for the augmentation.
#pragma once

#include <vector>

#include "catena/assembly/hessian_slots.hpp"
#include "catena/assembly/plan.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

struct KktStructure {
  int columns = 0;         ///< coordinates
  int rows = 0;            ///< constraint rows
  int moving = 0;          ///< bodies solved for
  SparsePattern pattern;   ///< lower triangle of the matrix with R = E = 0, size columns + rows
  std::vector<int> order;  ///< elimination order: place k holds row order[k] of the matrix
  /// Rows of a body, or of an element: node k holds places node_start[k] ... node_start[k + 1] - 1 of the order.
  std::vector<int> node_start;
  std::vector<int> diagonal;  ///< slot of the diagonal entry of every coordinate: the first one of its column
  HessianSlots hessian;
  std::vector<int> jacobian;  ///< slot of every entry of Phi_q

  // Phi_q by rows: entries row_start[r] ... row_start[r + 1] - 1 of row_entry are entries of Phi_q in row r.
  std::vector<int> row_start, row_entry;
  int product_count = 0;  ///< of two entries of the same row, the second not after the first, all rows in turn

  int entries() const { return pattern.entries(); }
  /// Values of the pattern come first; then the further values of the factored matrix: products, and -eps of every
  /// equation; then one stiffness against turning a body, and one place for the unused values of immobile bodies.
  int products() const { return entries(); }
  int regularisation() const { return products() + product_count; }
  int factored() const { return regularisation() + rows; }
  int turning(int body) const { return factored() + body; }
  int trash() const { return factored() + moving; }
  int values() const { return trash() + 1; }

  explicit KktStructure(const Plan& plan);

  /// Places of the values 0 ... factored() - 1 in the matrix that is factored, where equal places add up.
  std::vector<MatrixEntry> factored_places() const;
};

}  // namespace catena
