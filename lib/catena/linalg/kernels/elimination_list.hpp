// LU factors of small diagonal blocks, eliminated and solved with by lists of products that are made once a choice of
// pivots.
//
//   factors     for every place p of a block:   a_ij -= (a_ip / a_pp) a_pj        i, j > p
//   solutions   w = D^-1 b,   then   w_t -= v w_s   for every entry of D^-1 L D, of D^-1 U, and outside of the blocks
//
// D holds the pivots. Ordering and pivots are given (KLU's). Which entries fill in follows from them, so that the place
// of every entry and the target of every product are known beforehand: there is no search and no branch. Blocks are
// solved one after the other, the last one first; transposed, the list is read backwards with t and s exchanged. KLU's
// own loops cost some hundred instructions a column, more than the arithmetic of a mechanism of a dozen links.
// A pivot of zero gives factors that are not finite; the caller looks at the pivots.
// Source: T. Davis, Direct Methods for Sparse Linear Systems (2006), chapter 6; the row scaling by D leaves the
// componentwise backward error of substitution as it is (N. Higham, Accuracy and Stability, 2002, section 8.1).
#pragma once

#include <span>
#include <vector>

#include "catena/linalg/kernels/lanes.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

class EliminationList {
 public:
  /// Blocks of more rows are not made into a list: the rows of a block are bits of one word while it is made.
  static constexpr int largest_block = 64;

  /// Row and column at every place of the permuted matrix, and where its diagonal blocks begin (blocks + 1 places).
  struct Order {
    std::span<const int> row, column, block_start;
  };
  /// Whether all blocks are small enough.
  static bool serves(std::span<const int> block_start);

  /// Entry k of the pattern is multiplied by entry_scale[k] before it is factored. Allocates.
  EliminationList(const SparsePattern& pattern, const Order& order, std::span<const double> entry_scale);

  /// Factors the matrix with these values, as many as the pattern has entries. Allocates nothing.
  void factor(std::span<const double> values);
  /// Per place; the largest magnitude of L below the pivot at a place.
  std::span<const double> pivots() const { return pivot_; }
  double largest_multiplier(int place) const;

  /// x = C A^-1 R x for one right-hand side, A the scaled matrix: R `row_factor`, C `column_factor` (empty: 1), in the
  /// caller's numbering.
  void solve(std::span<double> x, std::span<const double> row_factor, std::span<const double> column_factor) {
    solve_in(x, row_factor, column_factor, std::span(work_));
  }
  /// The same for four right-hand sides at once, rounded as one by one. Allocates at the first call.
  void solve(std::span<Lanes> x, std::span<const double> row_factor, std::span<const double> column_factor) {
    lanes_.resize(row_.size());
    solve_in(x, row_factor, column_factor, std::span(lanes_));
  }
  /// x = R A^-T C x.
  void solve_transposed(std::span<double> x, std::span<const double> row_factor, std::span<const double> column_factor);

 private:
  // Of place p, one after the other in `value_`: its pivot, the entries below it, those to the right of it.
  struct Place {
    int pivot, below, right;  // `pivot`: where; how many of the others
    int target;               // of its first product in target_
  };
  // An entry that solutions are multiplied by: w[target] -= value_[slot] / pivot(target) * w[source].
  struct Entry {
    int target, source, slot;
  };
  void find_fill(const SparsePattern& pattern);
  void list_products();
  void list_entries(const SparsePattern& pattern);
  int slot_in_block(int row_place, int column_place) const;
  template <class V>
  void solve_in(std::span<V> x, std::span<const double> row_factor, std::span<const double> column_factor,
                std::span<V> work) const;

  std::vector<int> row_, column_, block_start_;
  std::vector<int> row_place_, first_of_;  // place of every row; where the block of every place begins
  std::vector<Place> places_;
  std::vector<int> index_;   // per entry of a block in value_: place of its row (below) or column (right)
  std::vector<int> target_;  // of the products, pivot after pivot, row after row
  std::vector<int> slot_;    // per entry of the pattern: where it stands in value_
  std::vector<Entry> entries_;
  std::vector<double> entry_scale_, value_, factor_;  // factor_: per entry of entries_
  std::vector<double> pivot_, inverse_, work_;
  std::vector<Lanes> lanes_;
};

}  // namespace catena
