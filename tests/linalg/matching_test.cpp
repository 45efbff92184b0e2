#include "catena/linalg/patterns/matching.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "linalg/matrices.hpp"

namespace catena::testing {
namespace {

/// Size of a maximum matching by single augmenting paths, simple enough to be right by inspection.
int rank_by_augmenting_paths(const SparsePattern& pattern) {
  std::vector<int> column_of_row(pattern.rows, -1);
  int size = 0;
  for (int start = 0; start < pattern.columns; ++start) {
    std::vector<bool> seen(pattern.rows, false);
    const std::function<bool(int)> augment = [&](int column) {
      for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k) {
        const int row = pattern.row_index[k];
        if (seen[row]) continue;
        seen[row] = true;
        if (column_of_row[row] < 0 || augment(column_of_row[row])) {
          column_of_row[row] = column;
          return true;
        }
      }
      return false;
    };
    size += augment(start);
  }
  return size;
}

bool has_entry(const SparsePattern& pattern, int row, int column) {
  const auto begin = pattern.row_index.begin() + pattern.column_start[column];
  const auto end = pattern.row_index.begin() + pattern.column_start[column + 1];
  return std::binary_search(begin, end, row);
}

TEST(MaximumMatching, IsAMatchingOfLargestSize) {
  Random random(61);
  for (int round = 0; round < 200; ++round) {
    const int rows = random.below(30), columns = 1 + random.below(30);
    std::vector<MatrixEntry> entries;
    for (int k = random.below(2 * columns + 1); k > 0 && rows > 0; --k)
      entries.push_back({random.below(rows), random.below(columns)});
    const SparsePattern pattern = build_pattern(rows, columns, entries).pattern;
    const Matching matching = maximum_matching(pattern);
    EXPECT_EQ(matching.structural_rank, rank_by_augmenting_paths(pattern));
    int matched = 0;
    for (int row = 0; row < rows; ++row) {
      const int column = matching.column_of_row[row];
      EXPECT_EQ(column < 0, std::binary_search(matching.unmatched_rows.begin(), matching.unmatched_rows.end(), row));
      if (column < 0) continue;
      ++matched;
      EXPECT_TRUE(has_entry(pattern, row, column));
      EXPECT_EQ(matching.row_of_column[column], row);
    }
    EXPECT_EQ(matched, matching.structural_rank);
    EXPECT_EQ(static_cast<int>(matching.unmatched_columns.size()), columns - matched);
  }
}

TEST(MaximumMatching, HandlesLongAugmentingPaths) {
  // Every column but the last is matched greedily one row too early: the last one's path leads through all of them.
  const int n = 200000;
  std::vector<MatrixEntry> entries;
  for (int k = 0; k + 1 < n; ++k) {
    entries.push_back({k, k});
    entries.push_back({k + 1, k});
  }
  entries.push_back({0, n - 1});
  EXPECT_EQ(maximum_matching(build_pattern(n, n, entries).pattern).structural_rank, n);
}

TEST(MaximumMatching, EmptyPatterns) {
  EXPECT_EQ(maximum_matching(SparsePattern{}).structural_rank, 0);
  const Matching none = maximum_matching(build_pattern(2, 3, {}).pattern);
  EXPECT_EQ(none.structural_rank, 0);
  EXPECT_EQ(none.unmatched_rows.size(), 2u);
  EXPECT_EQ(none.unmatched_columns.size(), 3u);
}

}  // namespace
}  // namespace catena::testing
