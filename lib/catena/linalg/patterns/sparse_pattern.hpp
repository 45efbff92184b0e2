// Pattern of a sparse matrix in compressed columns, and the few operations on pattern + values that the layers above
// need. The pattern is made once from (row, column) pairs; values live in a separate array and are written through
// slots, which is 14-20 times faster than triplets sorted at every evaluation.
//
// Column j holds the entries column_start[j] ... column_start[j + 1] - 1; their row indices ascend, without duplicates.
#pragma once

#include <span>
#include <vector>

namespace catena {

struct SparsePattern {
  int rows = 0;
  int columns = 0;
  std::vector<int> column_start{0};  ///< size columns + 1
  std::vector<int> row_index;        ///< size entries()

  int entries() const { return column_start.back(); }

  friend bool operator==(const SparsePattern&, const SparsePattern&) = default;
};

/// Place of one value: the same pair may be given several times, its values are then meant to be added.
struct MatrixEntry {
  int row;
  int column;
};

/// A pattern and the way into it: the value of input entry k belongs into values[slot[k]].
struct SlottedPattern {
  SparsePattern pattern;
  std::vector<int> slot;
};

/// Sorts the pairs by two counting sorts (linear time), merges equal ones.
/// Throws std::out_of_range for an index outside rows x columns, std::length_error beyond 2^31 - 1 entries.
SlottedPattern build_pattern(int rows, int columns, std::span<const MatrixEntry> entries);

/// The transposed pattern; entry k of `pattern` is entry slot[k] of the transposed one.
SlottedPattern transpose(const SparsePattern& pattern);

/// y += A x.  x: columns values, y: rows values.
void multiply_add(const SparsePattern& pattern, std::span<const double> values, std::span<const double> x,
                  std::span<double> y);

/// y += A^T x.  x: rows values, y: columns values.
void multiply_transposed_add(const SparsePattern& pattern, std::span<const double> values, std::span<const double> x,
                             std::span<double> y);

}  // namespace catena
