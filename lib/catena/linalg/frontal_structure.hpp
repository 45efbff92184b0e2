// What a multifrontal factorization of a symmetric sparse matrix needs to know beforehand: which rows of L belong
// together, where every value of the matrix goes, and in which order the parts are worked off.
//
// The matrix comes in nodes: rows that are eliminated together and share their neighbours, such as the coordinates of a
// body. Fill-in is found on the graph of nodes, several times smaller than that of rows. Nodes whose columns of L have
// the same rows are joined into a front, a dense lower trapezoid
//
//   [ L11 D11 ]   c columns                  the update -L21 D L21^T of the rows below is handed on to the parent
//   [ L21     ]   r rows below               in the elimination tree
//
// Fronts are in postorder, so that updates wait on a stack whose places are fixed here. Linear in the entries of L.
// Sources: J. Liu, "The role of elimination trees in sparse factorization", SIAM J. Matrix Anal. Appl. 11 (1990);
// J. Liu, "The multifrontal method for sparse matrix solution", SIAM Review 34 (1992).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "catena/linalg/sparse_pattern.hpp"

namespace catena {

struct FrontalStructure {
  /// One front. Its trapezoid, stored by columns, its rows and its values begin where those of the front before end.
  struct Front {
    int first = 0;    ///< place of its first column; columns are places first ... first + columns - 1
    int columns = 0;  ///< c
    int below = 0;    ///< r
    int values = 0;   ///< where its part of `source` and `target` begins

    int height() const { return columns + below; }
  };
  /// The r x r update of a front.
  struct Update {
    std::size_t waiting = 0;  ///< where it waits on the stack
    std::size_t formed = 0;   ///< where it is formed, above the updates of the children
    std::size_t rows = 0;     ///< where the front's part of `rows` and `relative` begins
  };

  std::vector<Front> fronts;     ///< and one more that closes the lists
  std::vector<Update> updates;   ///< of every front
  std::vector<int> order;        ///< place k of the elimination holds row order[k]
  std::vector<int> place;        ///< the inverse
  std::vector<int> rows;         ///< places of the rows below the columns of a front, ascending
  std::vector<int> relative;     ///< the same as rows of the parent's front
  std::vector<int> child_start;  ///< children of front s: child[child_start[s]] ... child[child_start[s + 1] - 1]
  std::vector<int> child;
  std::vector<int> source;        ///< values of the matrix by fronts: their number ...
  std::vector<int> target;        ///< ... and where it goes in the trapezoid
  std::size_t panel_entries = 0;  ///< size of all trapezoids
  std::size_t stack_entries = 0;  ///< size of the stack of updates

  FrontalStructure() = default;
  /// Value k of the matrix belongs to entries[k], of either triangle; values of equal places add up. `order`: a
  /// permutation of the rows. Node k: the rows order[node_start[k]] ... order[node_start[k + 1] - 1]. The order of
  /// nodes is changed only where that changes no number. Throws std::invalid_argument for what is none of this.
  FrontalStructure(std::span<const MatrixEntry> entries, std::span<const int> order, std::span<const int> node_start);

  int count() const { return static_cast<int>(fronts.size()) - 1; }
  int size() const { return static_cast<int>(order.size()); }

 private:
  void make_fronts(const std::vector<int>& width, const std::vector<int>& parent,
                   const std::vector<std::size_t>& below_start, const std::vector<int>& below);
  void list_values(std::span<const MatrixEntry> entries);
  void list_children(const std::vector<int>& parent_of_front);
};

}  // namespace catena
