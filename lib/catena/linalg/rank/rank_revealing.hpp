// Numerical rank of a rectangular sparse matrix (a constraint Jacobian): a maximal set of independent rows, for every
// other row the combination of rows that makes it superfluous, and a basis of the null space (the free motions).
// Nothing dense of size n x n is formed; 1e5 rows are usual.
//
// How the rank is found and checked:
// 1. Rows and columns are scaled to length one (columns by a bounded factor, so that a column of rounding errors stays
//    one), which makes the result independent of units, of squared forms and of scaled copies of a row.
// 2. Rows are taken in the order of the block triangular form (column_order.hpp), so that every loop of a mechanism is
//    judged by itself. A row is dependent when its part orthogonal to those before it is at most `tolerance` long: QR
//    of A^T with SPQR. Free columns are found in the same way from A, or, where they are many and no row is dependent,
//    by a matching.
// 3. QR detects neither exactly nor always. `verified` says that every combination was evaluated with A itself, that
//    rows and columns, analysed independently, gave the same rank, that the pattern allows it, and that no row was kept
//    by less than ten times the tolerance. A matrix with lengths near the tolerance has no definite rank.
// Without SPQR the rank comes from pivots of A A^T, blind below gram_tolerance: `approximate` is set, with a warning.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/kernels/kernel_info.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"
#include "catena/linalg/rank/column_dependencies.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {

struct RankOptions {
  /// Length (sine of an angle) below which a scaled row counts as a combination of others.
  double tolerance = dependence::follows;
  int most_dependencies = 100'000;    ///< left null vectors are left out when there are more dependent rows
  int most_null_vectors = 64;         ///< right null vectors are left out when the nullity is larger
  Kernel kernel = Kernel::automatic;  ///< spqr, cholmod (pivots of A A^T), or automatic: spqr where compiled in
};

struct RankReport {
  FactorStatus status = FactorStatus::ok;  ///< unavailable, out_of_memory or not_finite: nothing else holds
  int rank = 0;
  std::vector<int> independent_rows;  ///< ascending; a maximal independent set
  std::vector<int> dependent_rows;    ///< ascending; those left over
  /// Vector k: sum of value * row(index) = 0, the coefficient of dependent_rows[k] is 1 and comes first; the rest lies
  /// in independent rows. Empty when there are more than most_dependencies.
  SparseVectors left_null_vectors;
  std::vector<int> free_columns;  ///< ascending; columns whose values may be chosen, columns - rank of them
  /// Vector k: A v = 0, with 1 in free_columns[k] (first) and the rest in columns that are not free. Empty when there
  /// are more than most_null_vectors.
  SparseVectors right_null_vectors;
  double smallest_kept = 1;   ///< least length of a scaled independent row's part orthogonal to those before it
  int weakest_row = -1;       ///< the row it belongs to: the one nearest to dependence, -1 without independent rows
  double worst_residual = 0;  ///< over all null vectors of the scaled matrix: largest component / largest term
  bool verified = false;      ///< all checks passed
  bool approximate = false;   ///< found without SPQR
  std::string warning;        ///< one sentence when not verified or approximate

  bool ok() const { return status == FactorStatus::ok; }
};

/// values[k] belongs to entry k of the pattern (rows x columns, any shape, also empty).
RankReport reveal_rank(const SparsePattern& pattern, std::span<const double> values, const RankOptions& options = {});

}  // namespace catena
