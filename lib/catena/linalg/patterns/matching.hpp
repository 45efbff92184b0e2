// Maximum matching of rows and columns of a sparse pattern: the largest number of entries of which no two share a row
// or a column, the structural rank. No values can give the matrix a higher rank. Rectangular patterns are allowed.
//
// Hopcroft and Karp's algorithm: entries * sqrt(columns) steps at worst. The simpler search by single augmenting paths
// (SuiteSparse's BTF) is quadratic on chains whose drivers come last: half a minute for 3e4 links.
// Source: J. Hopcroft, R. Karp, SIAM J. Comput. 2 (1973).
#pragma once

#include <vector>

#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

struct Matching {
  int structural_rank = 0;
  std::vector<int> column_of_row;      ///< size rows, -1 where a row is left over
  std::vector<int> row_of_column;      ///< size columns, -1 where a column is left over
  std::vector<int> unmatched_rows;     ///< ascending
  std::vector<int> unmatched_columns;  ///< ascending
};

Matching maximum_matching(const SparsePattern& pattern);

}  // namespace catena
