// CHOLMOD's simplicial factorization behind plain types. It works on the permuted matrix: places, not rows of the
// caller's. For symmetric_factorization.cpp.
#pragma once

#include <memory>
#include <span>

#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/kernels/symmetric_options.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

/// L as CHOLMOD holds it: column k starts at start[k], has length[k] entries, and begins with the diagonal one, which
/// for L D L^T holds d_k instead of 1.
struct FactorColumns {
  std::span<const int> start;
  std::span<const int> length;
  const int* row = nullptr;
  const double* value = nullptr;
};

class CholmodKernel {
 public:
  CholmodKernel();
  ~CholmodKernel();
  CholmodKernel(CholmodKernel&&) noexcept;
  CholmodKernel& operator=(CholmodKernel&&) noexcept;

  /// Orders the n x n lower triangle, n >= 1, and counts the entries of L.
  /// Throws std::invalid_argument when the options' permutation or groups do not fit.
  FactorResult analyze(const SparsePattern& lower, const SymmetricOptions& options);

  std::span<const int> order() const;          ///< row of the caller's at every place
  std::span<const int> column_counts() const;  ///< entries in every column of L, diagonal included

  /// Factors the permuted matrix + shift I, given as the pattern and values of its upper triangle. A failure's index is
  /// a place. Allocates at the first call only.
  FactorResult factor(const SparsePattern& upper, std::span<const double> values, double shift);

  void solve(std::span<double> x);  ///< A X = B in place, in the caller's numbering; allocates at the first call only
  std::span<const double> pivots() const;  ///< D by places; for L L^T the squares of L's diagonal
  FactorColumns columns() const;
  double rcond() const;  ///< smallest over largest |pivot|

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace catena
