#include "catena/linalg/patterns/column_order.hpp"

#include <suitesparse/btf.h>
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "catena/linalg/patterns/matching.hpp"

namespace catena {
namespace {

/// Place of every column in COLAMD's order, which does not form A^T A; `rows` is the transposed pattern.
std::vector<int> places_by_colamd(const SparsePattern& rows) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(rows.rows);
  view.ncol = static_cast<std::size_t>(rows.columns);
  view.nzmax = rows.row_index.size();
  view.p = const_cast<int*>(rows.column_start.data());
  view.i = const_cast<int*>(rows.row_index.data());
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_PATTERN;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  std::vector<int> order(view.nrow), place(view.nrow);
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  if (!cholmod_colamd(&view, nullptr, 0, 1, order.data(), &common)) std::iota(order.begin(), order.end(), 0);
  cholmod_finish(&common);
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  return place;
}

enum class Part { over_determined, exact, under_determined };

/// Marks the columns that alternating paths reach from the columns left over by the matching, or, given the transposed
/// pattern and matching, the columns of rows that such paths reach from the rows left over.
void mark_reached(const SparsePattern& pattern, const std::vector<int>& partner_of_row, const std::vector<int>& starts,
                  std::vector<bool>& reached) {
  std::vector<int> queue = starts;
  for (int column : starts) reached[column] = true;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const int column = queue[head];
    for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k) {
      const int partner = partner_of_row[pattern.row_index[k]];
      if (partner < 0 || reached[partner]) continue;
      reached[partner] = true;
      queue.push_back(partner);
    }
  }
}

std::vector<Part> parts_of_columns(const SparsePattern& pattern, const SparsePattern& transposed,
                                   const Matching& matching) {
  std::vector<bool> over(static_cast<std::size_t>(pattern.columns), false);
  std::vector<bool> under_rows(static_cast<std::size_t>(pattern.rows), false);
  mark_reached(pattern, matching.column_of_row, matching.unmatched_columns, over);
  mark_reached(transposed, matching.row_of_column, matching.unmatched_rows, under_rows);
  std::vector<Part> parts(over.size(), Part::exact);
  for (std::size_t j = 0; j < parts.size(); ++j) {
    if (over[j])
      parts[j] = Part::over_determined;
    else if (under_rows[matching.row_of_column[j]])
      parts[j] = Part::under_determined;
  }
  return parts;
}

/// The needs among the exactly determined columns, as a square pattern in which every column holds itself as well.
SparsePattern needs_of(const SparsePattern& pattern, const std::vector<int>& column_of_row,
                       const std::vector<Part>& parts) {
  SparsePattern needs;
  needs.rows = needs.columns = pattern.columns;
  needs.row_index.reserve(pattern.row_index.size() + static_cast<std::size_t>(pattern.columns));
  for (int j = 0; j < pattern.columns; ++j) {
    needs.row_index.push_back(j);
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1] && parts[j] == Part::exact; ++k) {
      const int needed = column_of_row[pattern.row_index[k]];
      if (needed >= 0 && needed != j && parts[needed] == Part::exact) needs.row_index.push_back(needed);
    }
    needs.column_start.push_back(static_cast<int>(needs.row_index.size()));
  }
  return needs;
}

}  // namespace

std::vector<int> order_columns_by_need(const SparsePattern& pattern) {
  const auto n = static_cast<std::size_t>(pattern.columns);
  if (n == 0) return {};
  const SparsePattern transposed = transpose(pattern).pattern;
  const Matching matching = maximum_matching(pattern);
  const std::vector<Part> parts = parts_of_columns(pattern, transposed, matching);
  SparsePattern needs = needs_of(pattern, matching.column_of_row, parts);
  std::vector<int> by_need(n), block_start(n + 1), work(4 * n);
  const int blocks = btf_strongcomp(pattern.columns, needs.column_start.data(), needs.row_index.data(), nullptr,
                                    by_need.data(), block_start.data(), work.data());
  std::vector<int> block(n);
  for (int b = 0; b < blocks; ++b)
    for (int k = block_start[b]; k < block_start[b + 1]; ++k)
      block[by_need[k]] = parts[by_need[k]] == Part::exact ? b : 0;

  const std::vector<int> place = places_by_colamd(transposed);
  std::vector<int> order = std::move(by_need);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return std::tie(parts[i], block[i], place[i]) < std::tie(parts[j], block[j], place[j]);
  });
  return order;
}

}  // namespace catena
