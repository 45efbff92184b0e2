#include "catena/linalg/block/block_structure.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "catena/linalg/patterns/elimination_tree.hpp"

namespace catena {
namespace {

[[noreturn]] void refuse(const char* what) { throw std::invalid_argument(std::string("BlockStructure: ") + what); }

// Node of every row, after checks that every row occurs once.
std::vector<int> nodes_of_rows(std::span<const int> order, std::span<const int> node_start) {
  const int n = static_cast<int>(order.size());
  if (node_start.empty() || node_start.front() != 0 || node_start.back() != n) refuse("nodes must hold all rows");
  std::vector<int> node(order.size(), -1);
  for (std::size_t k = 0; k + 1 < node_start.size(); ++k) {
    if (node_start[k + 1] <= node_start[k]) refuse("empty node");
    for (int p = node_start[k]; p < node_start[k + 1]; ++p) {
      const int row = order[p];
      if (row < 0 || row >= n || node[row] >= 0) refuse("not a permutation of the rows");
      node[row] = static_cast<int>(k);
    }
  }
  return node;
}

// Neighbours of every node that are eliminated later.
SparsePattern later_neighbours(std::span<const MatrixEntry> entries, int nodes, const std::vector<int>& node) {
  const int rows = static_cast<int>(node.size());
  std::vector<MatrixEntry> pairs;
  MatrixEntry last{-1, -1};
  for (const MatrixEntry& entry : entries) {
    if (entry.row < 0 || entry.row >= rows || entry.column < 0 || entry.column >= rows) refuse("entry outside");
    const auto [first, second] = std::minmax(node[entry.row], node[entry.column]);
    // Most of those that repeat a pair follow each other.
    if (first == second || (first == last.column && second == last.row)) continue;
    last = {second, first};
    pairs.push_back(last);
  }
  return build_pattern(nodes, nodes, pairs).pattern;
}

}  // namespace

BlockStructure::BlockStructure(std::span<const MatrixEntry> entries, std::span<const int> given_order,
                               std::span<const int> node_start) {
  const std::vector<int> node = nodes_of_rows(given_order, node_start);
  const int nodes = static_cast<int>(node_start.size()) - 1;
  SparsePattern later = later_neighbours(entries, nodes, node);

  std::vector<int> parent = elimination_tree(later), width(parent.size());
  {
    // Everything by the places of the postorder from here on.
    const std::vector<int> old_node = postorder(parent);
    std::vector<int> new_node(old_node.size()), old_parent = std::move(parent);
    for (int k = 0; k < nodes; ++k) new_node[old_node[k]] = k;
    parent.resize(old_parent.size());
    SparsePattern renumbered{.rows = nodes, .columns = nodes, .column_start = {0}, .row_index = {}};
    renumbered.column_start.reserve(later.column_start.size());
    renumbered.row_index.reserve(later.row_index.size());
    order.reserve(given_order.size());
    for (int k = 0; k < nodes; ++k) {
      const int old = old_node[k];
      parent[k] = old_parent[old] < 0 ? -1 : new_node[old_parent[old]];
      width[k] = node_start[old + 1] - node_start[old];
      order.insert(order.end(), given_order.begin() + node_start[old], given_order.begin() + node_start[old + 1]);
      for (int e = later.column_start[old]; e < later.column_start[old + 1]; ++e) {
        renumbered.row_index.push_back(new_node[later.row_index[e]]);
      }
      renumbered.column_start.push_back(static_cast<int>(renumbered.row_index.size()));
    }
    later = std::move(renumbered);
  }
  place.resize(order.size());
  for (int k = 0; k < size(); ++k) place[order[k]] = k;

  const FactorStructure structure = factor_structure(later, parent);
  later = {};
  make_blocks(width, parent, structure.start, structure.row);
  list_values(entries);
}

// A node joins its child's block where their columns of L have the same rows: then neither holds zeros.
void BlockStructure::make_blocks(const std::vector<int>& width, const std::vector<int>& parent,
                                 const std::vector<std::size_t>& below_start, const std::vector<int>& below) {
  const int nodes = static_cast<int>(width.size());
  std::vector<int> first_place(width.size() + 1, 0), last_node;
  for (int k = 0; k < nodes; ++k) first_place[k + 1] = first_place[k] + width[k];
  const auto rows_below = [&](int node) {
    int count = 0;
    for (std::size_t k = below_start[node]; k < below_start[node + 1]; ++k) count += width[below[k]];
    return count;
  };
  for (int k = 0; k < nodes; ++k) {
    const int height = rows_below(k);
    const bool joins = k > 0 && parent[k - 1] == k && blocks.back().below == width[k] + height;
    if (!joins) {
      blocks.push_back({});
      blocks.back().first = first_place[k];
      last_node.push_back(k);
    }
    Block& block = blocks.back();
    block.columns += width[k];
    block.below = height;
    last_node.back() = k;
  }

  for (std::size_t s = 0; s < blocks.size(); ++s) {
    Block& block = blocks[s];
    block.rows = static_cast<int>(rows.size());
    panel_entries += static_cast<std::size_t>(block.height()) * static_cast<std::size_t>(block.columns);
    const int last = last_node[s];
    for (std::size_t k = below_start[last]; k < below_start[last + 1]; ++k) {
      for (int p = first_place[below[k]]; p < first_place[below[k] + 1]; ++p) rows.push_back(p);
    }
  }
  blocks.push_back({.first = size(), .rows = static_cast<int>(rows.size())});
}

// Every entry stands in the column of its earlier place.
void BlockStructure::list_values(std::span<const MatrixEntry> entries) {
  std::vector<int> block_of_place(order.size());
  for (int s = 0; s < count(); ++s) {
    for (int p = blocks[s].first; p < blocks[s + 1].first; ++p) block_of_place[p] = s;
  }
  std::vector<int> start(static_cast<std::size_t>(count()) + 1, 0);
  const auto visit = [&](auto&& f) {
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const auto [column, row] = std::minmax(place[entries[e].row], place[entries[e].column]);
      f(static_cast<int>(e), block_of_place[column], row, column);
    }
  };
  visit([&](int, int s, int, int) { ++start[s + 1]; });
  for (int s = 0; s < count(); ++s) start[s + 1] += start[s];
  for (std::size_t s = 0; s < blocks.size(); ++s) blocks[s].values = start[s];
  source.resize(entries.size());
  target.resize(source.size());
  visit([&](int e, int s, int row, int column) {
    const Block& block = blocks[s];
    const int* const list = rows.data() + block.rows;
    const int local = row < block.first + block.columns
                          ? row - block.first
                          : block.columns + static_cast<int>(std::lower_bound(list, list + block.below, row) - list);
    const int k = start[s]++;
    source[k] = e;
    target[k] = local + block.height() * (column - block.first);
  });
}

}  // namespace catena
