#include "catena/linalg/patterns/matching.hpp"

#include <cstddef>

namespace catena {
namespace {

/// One run of the algorithm: rounds of a breadth-first search that layers the columns by their distance from a free
/// one, each followed by depth-first searches along the layers for augmenting paths that share no column.
class HopcroftKarp {
 public:
  explicit HopcroftKarp(const SparsePattern& pattern)
      : pattern_(pattern),
        column_of_row_(static_cast<std::size_t>(pattern.rows), -1),
        row_of_column_(static_cast<std::size_t>(pattern.columns), -1),
        layer_(row_of_column_.size()),
        next_(row_of_column_.size()) {}

  Matching run() {
    match_greedily();
    while (layer_columns()) {
      next_.assign(pattern_.column_start.begin(), pattern_.column_start.end() - 1);
      for (int column = 0; column < pattern_.columns; ++column)
        if (row_of_column_[column] < 0) augment_from(column);
    }
    return result();
  }

 private:
  void match_greedily() {
    for (int column = 0; column < pattern_.columns; ++column) {
      for (int k = pattern_.column_start[column]; k < pattern_.column_start[column + 1]; ++k) {
        if (column_of_row_[pattern_.row_index[k]] >= 0) continue;
        match(column, pattern_.row_index[k]);
        break;
      }
    }
  }

  void match(int column, int row) {
    column_of_row_[row] = column;
    row_of_column_[column] = row;
  }

  /// False when no free row can be reached any more: the matching is maximal.
  bool layer_columns() {
    bool free_row_reached = false;
    queue_.clear();
    for (int column = 0; column < pattern_.columns; ++column) {
      layer_[column] = row_of_column_[column] < 0 ? 0 : -1;
      if (layer_[column] == 0) queue_.push_back(column);
    }
    for (std::size_t head = 0; head < queue_.size(); ++head) {
      const int column = queue_[head];
      for (int k = pattern_.column_start[column]; k < pattern_.column_start[column + 1]; ++k) {
        const int partner = column_of_row_[pattern_.row_index[k]];
        if (partner < 0) {
          free_row_reached = true;
        } else if (layer_[partner] < 0) {
          layer_[partner] = layer_[column] + 1;
          queue_.push_back(partner);
        }
      }
    }
    return free_row_reached;
  }

  /// Depth-first, with a stack of its own: augmenting paths may be as long as the mechanism.
  void augment_from(int start) {
    path_.assign(1, start);
    while (!path_.empty()) {
      const int column = path_.back();
      if (next_[column] == pattern_.column_start[column + 1]) {
        path_.pop_back();
        continue;
      }
      const int partner = column_of_row_[pattern_.row_index[next_[column]++]];
      if (partner < 0) {
        // Every column on the path takes the row at which its own search stands.
        for (int member : path_) match(member, pattern_.row_index[next_[member] - 1]);
        return;
      }
      if (layer_[partner] == layer_[column] + 1) path_.push_back(partner);
    }
  }

  Matching result() {
    Matching matching;
    for (int column = 0; column < pattern_.columns; ++column)
      if (row_of_column_[column] < 0) matching.unmatched_columns.push_back(column);
    for (int row = 0; row < pattern_.rows; ++row)
      if (column_of_row_[row] < 0) matching.unmatched_rows.push_back(row);
    matching.structural_rank = pattern_.rows - static_cast<int>(matching.unmatched_rows.size());
    matching.column_of_row = std::move(column_of_row_);
    matching.row_of_column = std::move(row_of_column_);
    return matching;
  }

  const SparsePattern& pattern_;
  std::vector<int> column_of_row_;
  std::vector<int> row_of_column_;
  std::vector<int> layer_;  // distance of a column from a free one along alternating paths, -1 if not reached
  std::vector<int> next_;   // entry of a column to be looked at next in this round
  std::vector<int> queue_;
  std::vector<int> path_;
};

}  // namespace

Matching maximum_matching(const SparsePattern& pattern) { return HopcroftKarp(pattern).run(); }

}  // namespace catena
