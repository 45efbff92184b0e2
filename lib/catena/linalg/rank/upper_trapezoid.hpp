// R of a rank-revealing QR factorization: live columns start a new row each and form the upper triangular R11, dead
// ones hold only entries of rows started before. For column_dependencies_qr.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catena/linalg/patterns/sparse_vectors.hpp"

namespace catena {

class UpperTrapezoid {
 public:
  /// Compressed columns of R, in pivot order; row indices within a column in any order.
  UpperTrapezoid(std::span<const std::int64_t> column_start, std::span<const std::int64_t> row_index,
                 std::span<const double> values);

  int rank() const { return static_cast<int>(live_.size()); }
  std::span<const int> live() const { return live_; }  ///< places of the live columns: live()[i] starts row i
  std::span<const int> dead() const { return dead_; }
  std::span<const double> diagonal() const { return diagonal_; }  ///< of R11

  /// Solves R11 c = R(:, place) for a dead column with the work its sparsity asks for (a depth-first search finds the
  /// rows that can be nonzero). A result of cancellation in a row below `negligible` times its terms and the column's
  /// length is taken as zero, a perturbation of R by as much: otherwise rounding errors would propagate through all
  /// rows on which it depends, amplified by every transmission ratio on the way. Appends (row of R11, coefficient)
  /// pairs.
  struct Entry {
    int row;
    double value;
  };
  void combination_of(int place, double negligible, std::vector<Entry>& combination);

  /// For every dead column the combination of columns of A that vanishes: 1 for the dead column, first, the negative
  /// coefficients of the live ones. order[place] is the column of A at a place.
  void append_null_vectors(std::span<const int> order, double negligible, SparseVectors& vectors);

 private:
  void search(int row);
  std::int64_t begin(int place) const { return column_start_[place]; }
  std::int64_t end(int place) const { return column_start_[place + 1]; }

  std::span<const std::int64_t> column_start_;
  std::span<const std::int64_t> row_index_;
  std::span<const double> values_;
  std::vector<int> live_;
  std::vector<int> dead_;
  std::vector<double> diagonal_;
  std::vector<double> work_;       // zero between calls
  std::vector<double> terms_;      // sum of the magnitudes added to work_, zero between calls
  std::vector<bool> reached_;      // false between calls
  std::vector<int> finish_order_;  // rows reached, every row after those that it feeds
  struct Visit {
    int row;
    std::int64_t next;
  };
  std::vector<Visit> stack_;
};

}  // namespace catena
