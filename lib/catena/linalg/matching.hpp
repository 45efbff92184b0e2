// Maximum matching of rows and columns of a sparse pattern: the largest number of entries of which no two share a row
// or a column, the structural rank. No values can give the matrix a higher rank. Rectangular patterns are allowed.
// Source: I. Duff, "On algorithms for obtaining a maximum transversal", ACM TOMS 7 (1981), as in SuiteSparse's BTF.
#pragma once

#include <vector>

#include "catena/linalg/sparse_pattern.hpp"

namespace catena {

struct Matching {
  int structural_rank = 0;
  std::vector<int> column_of_row;      ///< size rows, -1 where a row is left over
  std::vector<int> unmatched_rows;     ///< ascending
  std::vector<int> unmatched_columns;  ///< ascending
};

Matching maximum_matching(const SparsePattern& pattern);

}  // namespace catena
