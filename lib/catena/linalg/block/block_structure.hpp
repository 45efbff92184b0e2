// The structure of a factorization of a symmetric sparse matrix block by block: which rows of L belong together, where
// every value of the matrix goes, and the order of elimination.
//
// The matrix comes in nodes: rows that are eliminated together and share their neighbours, such as the coordinates of a
// body. Fill-in is found on the graph of nodes, several times smaller than that of rows. Nodes whose columns of L have
// the same rows are joined into a block, a dense lower trapezoid, stored by columns, its panel:
//
//   [ L11 D11 ]   c columns                  its elimination takes L21 D L21^T off the panels of later blocks
//   [ L21     ]   r rows below
//
// Blocks are in the postorder of the elimination tree. Linear in the entries of L.
// Source: J. Liu, "The role of elimination trees in sparse factorization", SIAM J. Matrix Anal. Appl. 11 (1990).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

struct BlockStructure {
  /// One block. Its trapezoid, stored by columns, its rows and its values begin where those of the block before end.
  struct Block {
    int first = 0;    ///< place of its first column; columns are places first ... first + columns - 1
    int columns = 0;  ///< c
    int below = 0;    ///< r
    int rows = 0;     ///< where its part of `rows` begins
    int values = 0;   ///< where its part of `source` and `target` begins

    int height() const { return columns + below; }
  };
  std::vector<Block> blocks;      ///< and one more that closes the lists
  std::vector<int> order;         ///< place k of the elimination holds row order[k]
  std::vector<int> place;         ///< the inverse
  std::vector<int> rows;          ///< places of the rows below the columns of a block, ascending
  std::vector<int> source;        ///< values of the matrix by blocks: their number ...
  std::vector<int> target;        ///< ... and where it goes in the trapezoid
  std::size_t panel_entries = 0;  ///< size of all trapezoids

  BlockStructure() = default;
  /// Value k of the matrix belongs to entries[k], of either triangle; values of equal places add up. `order`: a
  /// permutation of the rows. Node k: the rows order[node_start[k]] ... order[node_start[k + 1] - 1]. The order of
  /// nodes is changed only where that changes no number. Throws std::invalid_argument for arguments that violate this.
  BlockStructure(std::span<const MatrixEntry> entries, std::span<const int> order, std::span<const int> node_start);

  int count() const { return static_cast<int>(blocks.size()) - 1; }
  int size() const { return static_cast<int>(order.size()); }

 private:
  void make_blocks(const std::vector<int>& width, const std::vector<int>& parent,
                   const std::vector<std::size_t>& below_start, const std::vector<int>& below);
  void list_values(std::span<const MatrixEntry> entries);
};

}  // namespace catena
