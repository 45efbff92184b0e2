#include "catena/linalg/patterns/sparse_pattern.hpp"

#include <cassert>
#include <cstddef>
#include <limits>
#include <stdexcept>

namespace catena {
namespace {

/// counts[i + 1] = number of items with index i  ->  counts[i] = place of the first of them.
void accumulate_counts(std::vector<int>& counts) {
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] += counts[i - 1];
}

}  // namespace

SlottedPattern build_pattern(int rows, int columns, std::span<const MatrixEntry> entries) {
  if (rows < 0 || columns < 0) throw std::out_of_range("build_pattern: negative dimension");
  if (entries.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error("build_pattern: more than 2^31 - 1 entries");

  std::vector<int> row_next(static_cast<std::size_t>(rows) + 1, 0);
  std::vector<int> column_next(static_cast<std::size_t>(columns) + 1, 0);
  for (const MatrixEntry& entry : entries) {
    if (entry.row < 0 || entry.row >= rows || entry.column < 0 || entry.column >= columns)
      throw std::out_of_range("build_pattern: entry outside the matrix");
    ++row_next[entry.row + 1];
    ++column_next[entry.column + 1];
  }
  accumulate_counts(row_next);
  accumulate_counts(column_next);

  // Sorting by row first and then, stably, by column leaves the rows of every column ascending.
  const int count = static_cast<int>(entries.size());
  std::vector<int> by_row(entries.size());
  for (int k = 0; k < count; ++k) by_row[row_next[entries[k].row]++] = k;
  std::vector<int> by_column(entries.size());
  for (int k : by_row) by_column[column_next[entries[k].column]++] = k;

  SlottedPattern result;
  result.slot = std::move(by_row);  // its content is used up; the slots need the same space
  SparsePattern& pattern = result.pattern;
  pattern.rows = rows;
  pattern.columns = columns;
  pattern.column_start.assign(static_cast<std::size_t>(columns) + 1, 0);
  pattern.row_index.reserve(entries.size());
  int next = 0;
  for (int j = 0; j < columns; ++j) {
    int last_row = -1;
    for (; next < column_next[j]; ++next) {  // column_next[j] has advanced to the end of column j
      const int k = by_column[next];
      if (entries[k].row != last_row) {
        last_row = entries[k].row;
        pattern.row_index.push_back(last_row);
      }
      result.slot[k] = static_cast<int>(pattern.row_index.size()) - 1;
    }
    pattern.column_start[j + 1] = static_cast<int>(pattern.row_index.size());
  }
  return result;
}

SlottedPattern transpose(const SparsePattern& pattern) {
  SlottedPattern result;
  SparsePattern& transposed = result.pattern;
  transposed.rows = pattern.columns;
  transposed.columns = pattern.rows;
  transposed.column_start.assign(static_cast<std::size_t>(pattern.rows) + 1, 0);
  transposed.row_index.resize(pattern.row_index.size());
  result.slot.resize(pattern.row_index.size());

  for (int row : pattern.row_index) ++transposed.column_start[row + 1];
  accumulate_counts(transposed.column_start);
  std::vector<int> next(transposed.column_start.begin(), transposed.column_start.end() - 1);
  for (int j = 0; j < pattern.columns; ++j) {
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int place = next[pattern.row_index[k]]++;
      transposed.row_index[place] = j;
      result.slot[k] = place;
    }
  }
  return result;
}

void multiply_add(const SparsePattern& pattern, std::span<const double> values, std::span<const double> x,
                  std::span<double> y) {
  assert(values.size() == pattern.row_index.size());
  assert(x.size() == static_cast<std::size_t>(pattern.columns) && y.size() == static_cast<std::size_t>(pattern.rows));
  for (int j = 0; j < pattern.columns; ++j) {
    const double factor = x[j];
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
      y[pattern.row_index[k]] += values[k] * factor;
  }
}

void multiply_transposed_add(const SparsePattern& pattern, std::span<const double> values, std::span<const double> x,
                             std::span<double> y) {
  assert(values.size() == pattern.row_index.size());
  assert(x.size() == static_cast<std::size_t>(pattern.rows) && y.size() == static_cast<std::size_t>(pattern.columns));
  for (int j = 0; j < pattern.columns; ++j) {
    double sum = 0;
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
      sum += values[k] * x[pattern.row_index[k]];
    y[j] += sum;
  }
}

}  // namespace catena
