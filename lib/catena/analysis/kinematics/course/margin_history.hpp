// The distance of the diagonal blocks of Phi_q from singular ones along a motion, and what it says about a step.
//
// Branches that meet differ by the sign of a block's determinant: a change of sign within a step means a passage or a
// jump. With an even nullity the sign stays, but the block's smallest pivot dips. Both are judged from one instant to
// the next, relative to their own size; nothing is compared after clear(), when blocks or their equations changed.
// Units: as BlockMargin (factorization.hpp), time in s.
#pragma once

#include <span>
#include <vector>

#include "catena/linalg/factorization/factorization.hpp"

namespace catena {

class MarginHistory {
 public:
  bool empty() const { return last_.empty(); }
  /// Forgets the last instant: the next one taken is not compared with it.
  void clear() { last_.clear(); }
  /// Forgets the largest pivots too: the matrix consists of other equations from now on.
  void forget();
  /// Takes the margins at t.
  void take(std::span<const BlockMargin> margins, double t);

  /// Whether a block, extrapolated from the last two instants, is nearly singular a time h (s, not negative) later, or
  /// was so in between.
  bool heads_for_singularity(double h) const;

  struct Change {
    bool crossed = false;  ///< a determinant has changed its sign
    bool dipped = false;   ///< a determinant has fallen so far that it may vanish within the step
  };
  /// From the last instant to these margins; none where the blocks are not the same.
  Change change_to(std::span<const BlockMargin> margins) const;

  /// Whether the pivot of a block is below this part of the largest that it has been.
  bool has_fallen(std::span<const BlockMargin> margins, double part) const;
  /// The same at the last instant.
  bool has_fallen(double part) const { return has_fallen(last_, part); }

 private:
  bool is_small(std::span<const BlockMargin> margins, std::size_t block) const;

  std::vector<BlockMargin> last_;
  std::vector<double> rates_;    // of the magnitudes of the determinants, 1/s
  std::vector<double> largest_;  // of the magnitudes of the pivots so far
  double t_ = 0;
};

}  // namespace catena
