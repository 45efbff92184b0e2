// The elimination tree of a symmetric matrix, and the places below the diagonal in every column of its factor.
#pragma once

#include <cstddef>
#include <vector>

#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

/// Of the graph of nodes 0 ... n - 1, eliminated in this order. `later`: neighbours of every node among those that
/// follow, a pattern with n columns, in any order within a column. Result: the next node that each one's elimination
/// touches, -1 where there is none.
std::vector<int> elimination_tree(const SparsePattern& later);

/// A numbering in which every node comes directly after its last child, whole subtrees in a row: place k holds node
/// result[k]. Children keep their order.
std::vector<int> postorder(const std::vector<int>& parent);

/// Rows below the diagonal in the columns of the factor, ascending, for nodes in postorder.
struct FactorStructure {
  std::vector<std::size_t> start;  ///< of every column, and the end
  std::vector<int> row;
};
FactorStructure factor_structure(const SparsePattern& later, const std::vector<int>& parent);

}  // namespace catena
