// A x = b for a symmetric sparse matrix by P A P^T = L D L^T without pivoting, for matrices whose rows come in small
// nodes: the constraints of joints, the coordinates of bodies. Values of A are written directly into the storage of L,
// and so are the updates that the elimination of a block makes to later blocks: both places are computed beforehand, so
// that nothing is searched, stacked or copied. The loops of small blocks have constant lengths
// (small_block_kernels.hpp). Three times as fast as a factorization row by row where rows come in nodes of two to six.
//
//   analyze once;   then as often as wanted: factorize(values), or values() filled through slots() and factorize() in
//   place;          solve() as often as wanted
//
// Nothing allocates after the analysis. Which matrices: quasi-definite ones and others for which L D L^T exists in the
// given order (symmetric_factorization.hpp says more). Singular case: a pivot of exactly zero, or one that is not
// finite, stops the factorization and names the row.
// Source: E. Ng, B. Peyton, "Block sparse Cholesky algorithms on advanced uniprocessor computers", SIAM J. Sci. Comput.
// 14 (1993), of which this is the right-looking form.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "catena/base/counters.hpp"
#include "catena/linalg/block/block_structure.hpp"
#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/kernels/lanes.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

class BlockFactorization {
 public:
  /// Finds the structure of L; see BlockStructure for the arguments. Throws std::length_error where L has more than
  /// 2^31 - 1 entries.
  void analyze(std::span<const MatrixEntry> entries, std::span<const int> order, std::span<const int> node_start,
               Counters& counters);

  /// Where the value of every entry that was given to analyze() is added. Size: entries.
  std::span<const int> slots() const { return slots_; }
  /// Where values go; all others must be zero. factorize() overwrites them.
  std::span<double> values() { return panels_; }

  /// Factors what stands in values(). singular and not_finite name the row.
  FactorResult factorize(Counters& counters);
  /// The same for values in the order of the entries. Throws std::invalid_argument for another number of them.
  FactorResult factorize(std::span<const double> values, Counters& counters);

  /// A x = b in place. Throws std::logic_error without a valid factorization.
  void solve(std::span<double> x, Counters& counters);
  /// The same for four right-hand sides at once, rounded as one by one. `work` is given its size.
  void solve(std::span<Lanes> x, std::vector<Lanes>& work, Counters& counters);
  /// The same for `width` of them, a multiple of four: row r of x begins at r x width (linalg/kernels/packs.hpp).
  void solve_rows(double* x, std::size_t width, std::vector<double>& work, Counters& counters);

  int size() const { return structure_.size(); }
  bool is_analyzed() const { return structure_.count() >= 0; }
  bool is_factorized() const { return factorized_; }
  /// Number of negative pivots: by Sylvester's law that of negative eigenvalues.
  int negative_pivots() const;
  /// Diagonal entry of D that belongs to a row.
  double pivot(int row) const;
  /// Entries in the stored trapezoids.
  std::size_t factor_entries() const { return structure_.panel_entries; }
  /// Row of the caller's at every place of the elimination.
  std::span<const int> order() const { return structure_.order; }
  /// D by places.
  std::span<const double> pivots() const { return pivots_; }

 private:
  /// Rows first ... end - 1 below a large block that are columns of one and the same later block.
  struct Segment {
    int first, end;
    int panel;     ///< where the later block stands
    int height;    ///< of the later block
    int relative;  ///< where the list of its rows for first, first + 1, ... begins
  };
  /// One block, in the order of elimination: panels, rows and places follow each other.
  struct Step {
    int first;           ///< place of its first column
    short shape;         ///< code of small_block_kernels.hpp; 0: a large block
    int columns, below;  ///< c, r
    int segments;        ///< of a large block: number of its segments
  };

  void place_updates();
  template <class V>
  void solve_in(std::span<V> x, std::vector<V>& work);
  /// y in the order of elimination.
  template <class V>
  void solve_in_order(V* y) const;
  struct RowsKernel;
  void eliminate_large(const Step& step, double* panel, const Segment* segments, int* done);

  BlockStructure structure_;
  std::vector<Step> steps_;
  std::vector<int> slots_;         ///< of the entries
  std::vector<int> update_slots_;  ///< of small blocks: where their updates go, by columns of the lower triangle
  std::vector<Segment> segments_;
  std::vector<int> relative_;
  std::vector<double> panels_, pivots_, work_, column_;
  bool factorized_ = false, factored_before_ = false;
};

}  // namespace catena
