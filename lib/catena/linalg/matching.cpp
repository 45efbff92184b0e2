#include "catena/linalg/matching.hpp"

#include <suitesparse/btf.h>

#include <cstddef>

namespace catena {

Matching maximum_matching(const SparsePattern& pattern) {
  Matching matching;
  matching.column_of_row.assign(static_cast<std::size_t>(pattern.rows), -1);
  if (pattern.rows > 0 && pattern.columns > 0) {
    std::vector<int> work(5 * static_cast<std::size_t>(pattern.columns));
    double search_work = 0;
    matching.structural_rank = btf_maxtrans(
        pattern.rows, pattern.columns, const_cast<int*>(pattern.column_start.data()),
        const_cast<int*>(pattern.row_index.data()), 0.0, &search_work, matching.column_of_row.data(), work.data());
  }
  std::vector<bool> column_is_matched(static_cast<std::size_t>(pattern.columns), false);
  for (int row = 0; row < pattern.rows; ++row) {
    const int column = matching.column_of_row[row];
    if (column < 0)
      matching.unmatched_rows.push_back(row);
    else
      column_is_matched[column] = true;
  }
  for (int column = 0; column < pattern.columns; ++column)
    if (!column_is_matched[column]) matching.unmatched_columns.push_back(column);
  return matching;
}

}  // namespace catena
