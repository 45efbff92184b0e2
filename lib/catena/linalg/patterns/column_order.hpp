// An order of columns in which linear dependence is, where possible, a local question.
//
// Why: a drive train of sixty stages, each regular, has a smallest singular value of ratio^60, and a factorization in
// an arbitrary order would call it dependent. Columns and rows are matched; a column needs the columns matched to its
// other rows, and the strongly connected sets of that relation are the diagonal blocks of the block triangular form.
// Taken in the order of need, every block is judged by itself, and fill-in stays within blocks.
//
// That holds for the part which the pattern determines exactly. Where columns are left over (over-determined, placed
// first) or rows are (under-determined, placed last), the matching is arbitrary and its needs mean nothing: there
// COLAMD alone decides, which limits the fill-in of A^T A. Source: A. Pothen, C.-J. Fan, "Computing the block
// triangular form of a sparse matrix", ACM TOMS 16 (1990).
#pragma once

#include <vector>

#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

/// A permutation of the columns: over-determined part, exactly determined blocks, under-determined part.
std::vector<int> order_columns_by_need(const SparsePattern& pattern);

}  // namespace catena
