// Which columns of a sparse matrix depend linearly on others, and how: the core of rank_revealing. Works on a matrix
// whose columns are scaled to length one; both methods leave n x n dense arrays aside and scale to 1e5 columns.
#pragma once

#include <span>
#include <vector>

#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"
#include "catena/linalg/patterns/sparse_vectors.hpp"

namespace catena {

struct ColumnDependencies {
  FactorStatus status = FactorStatus::ok;
  std::vector<int> independent;  ///< a maximal independent set of columns
  std::vector<int> dependent;    ///< the others
  SparseVectors null_vectors;    ///< vector k: coefficients of a vanishing combination, 1 for column dependent[k], the
                                 ///< rest in independent columns; empty when more than the limit were found
  double smallest_kept = 1;      ///< least length of an independent column's part orthogonal to those before it
  int weakest = -1;              ///< the column it belongs to, -1 without independent columns
};

/// QR factorization with rank detection (SPQR) in the order of column_order.hpp: a column is dependent when its part
/// orthogonal to the columns before it is at most `tolerance` long (L. Foster, T. Davis, "Algorithm 933", ACM TOMS 40
/// (2013), after Heath). unavailable: built without SPQR.
ColumnDependencies dependencies_by_qr(const SparsePattern& pattern, std::span<const double> values, double tolerance,
                                      int most_null_vectors);

/// The substitute without SPQR: pivots of L D L^T of A^T A in the same order. They are the squares of those lengths, so
/// that columns closer to dependence than gram_tolerance count as dependent.
ColumnDependencies dependencies_by_gram_matrix(const SparsePattern& pattern, std::span<const double> values,
                                               int most_null_vectors);
inline constexpr double gram_tolerance = 1e-5;

}  // namespace catena
