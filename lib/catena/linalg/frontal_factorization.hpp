// A x = b for a symmetric sparse matrix by P A P^T = L D L^T without pivoting, in small dense fronts (multifrontal):
// three to four times as fast as a factorization row by row where the rows come in nodes of two to six, as those of
// bodies and joints do, in chains and in nets. `analyze` once, `factorize` at every change of the values, `solve` as
// often as wanted; after the analysis neither allocates.
//
// Which matrices: quasi-definite ones and others for which L D L^T exists in the given order
// (symmetric_factorization.hpp says more; pivots and inertia are the same as there). Singular case: a pivot of exactly
// zero, or one that is not finite, stops the factorization and names the row.
// Source: J. Liu, "The multifrontal method for sparse matrix solution", SIAM Review 34 (1992).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/base/counters.hpp"
#include "catena/linalg/factor_result.hpp"
#include "catena/linalg/frontal_structure.hpp"
#include "catena/linalg/sparse_pattern.hpp"

namespace catena {

class FrontalFactorization {
 public:
  /// Finds the structure of L; see FrontalStructure for the arguments.
  void analyze(std::span<const MatrixEntry> entries, std::span<const int> order, std::span<const int> node_start,
               Counters& counters);

  /// Factors A; values[k] belongs to entries[k]. singular and not_finite name the row.
  FactorResult factorize(std::span<const double> values, Counters& counters);

  /// A x = b in place. Throws std::logic_error without a valid factorization.
  void solve(std::span<double> x, Counters& counters);

  int size() const { return structure_.size(); }
  bool is_analyzed() const { return structure_.count() >= 0; }
  bool is_factorized() const { return factorized_; }
  /// Number of negative pivots: by Sylvester's law that of negative eigenvalues.
  int negative_pivots() const { return negative_; }
  /// Diagonal entry of D that belongs to a row.
  double pivot(int row) const;
  /// Entries in the stored trapezoids.
  std::size_t factor_entries() const { return structure_.panel_entries; }

 private:
  void assemble(int s, const double* values, double* panel);

  FrontalStructure structure_;
  std::unique_ptr<double[]> panels_;
  std::vector<double> stack_, pivots_, work_;
  int negative_ = 0;
  bool factorized_ = false, factored_before_ = false;
};

}  // namespace catena
