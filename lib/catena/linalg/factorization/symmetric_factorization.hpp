// A x = b for a symmetric sparse matrix, P A P^T = L D L^T or L L^T without pivoting (CHOLMOD, simplicial): one matrix
// row after the other along the elimination tree. `analyze` once, `factorize` at every change of the values, `solve` as
// often as wanted; after the first round neither allocates.
//
// Which matrices: positive definite ones (Phi_q M^-1 Phi_q^T of independent rows; either form), and symmetric
// quasi-definite ones [H, B^T; B, -C] with H and C positive definite, for which L D L^T exists in any order. Accuracy
// still depends on the order: with a small C, joints eliminated before their bodies divide by it and lose every digit
// (residuals up to 1e9 with a free minimum-degree order). Hence SymmetricOrdering::grouped, and refinement on top.
// Singular case: a pivot of exactly zero (or below, for L L^T) stops the factorization and names the row; nearly
// vanishing pivots show in smallest_pivot_ratio().
// Sources: Y. Chen, T. Davis, W. Hager, S. Rajamanickam, "Algorithm 887: CHOLMOD", ACM TOMS 35 (2008);
// R. Vanderbei, "Symmetric quasidefinite matrices", SIAM J. Optim. 5 (1995).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catena/base/counters.hpp"
#include "catena/linalg/factorization/refinement.hpp"
#include "catena/linalg/kernels/cholmod_kernel.hpp"
#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/kernels/symmetric_options.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

/// Numbers of positive, negative and (nearly) vanishing pivots: by Sylvester's law those of the eigenvalues.
struct Inertia {
  int positive = 0;
  int negative = 0;
  int zero = 0;

  friend bool operator==(const Inertia&, const Inertia&) = default;
};

/// How much of a pivot cancellation left: |d_k| / (|a_kk + shift| + sum_j l_kj^2 |d_j|), 1 = nothing lost. For a
/// Schur complement Phi_q M^-1 Phi_q^T it is sin^2 of the angle between constraint row k and the rows before it.
struct PivotRatio {
  double ratio = 1;
  int row = -1;  ///< in the caller's numbering
};

class SymmetricFactorization {
 public:
  /// Orders the matrix. `lower`: square pattern of the lower triangle, diagonal included where it is not zero.
  /// Throws std::invalid_argument for entries above the diagonal and for wrong permutations or groups.
  FactorResult analyze(const SparsePattern& lower, const SymmetricOptions& options, Counters& counters);

  /// Factors A + shift I; values[k] belongs to entry k of the pattern. singular and not_finite name the row.
  FactorResult factorize(std::span<const double> values, double shift, Counters& counters);

  /// A X = B in place; x holds one or several right-hand sides, one after the other.
  /// Throws std::logic_error without a valid factorization.
  void solve(std::span<double> x, Counters& counters);

  /// Solves and then refines against the true matrix, which may differ from the factored one (shifted, regularised).
  /// `residual(x, r)` writes r = b - A x and returns its size in the caller's own measure; see refinement.hpp.
  template <class Residual>
  Refinement solve_refined(std::span<double> x, Residual&& residual, const RefinementLimits& limits,
                           Counters& counters) {
    solve(x, counters);
    return refine([&](std::span<double> correction) { solve(correction, counters); }, residual, x, residual_work_,
                  correction_work_, limits);
  }

  int size() const { return static_cast<int>(order_.size()); }
  bool is_factorized() const { return factorized_; }

  /// Place k of the elimination order holds row order()[k].
  std::span<const int> order() const { return order_; }

  /// L by places of the elimination order; valid until the next `factorize` or `analyze`.
  FactorColumns factor_columns() const;

  /// Entries in L, diagonal included.
  std::int64_t factor_entries() const;

  /// Diagonal entry of D (for L L^T the square of L's) that belongs to a row.
  double pivot(int row) const;

  /// Pivots whose ratio (see PivotRatio) is at most zero_ratio count as zero.
  Inertia inertia(double zero_ratio = 0) const;

  double pivot_ratio(int row) const;
  PivotRatio smallest_pivot_ratio() const;

  /// Smallest over largest |pivot|, a crude reciprocal condition number; 0 without a valid factorization.
  double rcond() const;

 private:
  void prepare_upper_triangle(const SparsePattern& lower);
  void require_factors() const;
  const std::vector<double>& pivot_references() const;

  CholmodKernel kernel_;
  bool factorized_ = false;
  bool factored_before_ = false;
  double shift_ = 0;
  std::vector<int> order_;
  std::vector<int> place_;   // inverse of order_
  std::vector<int> source_;  // entry of the caller's values behind every entry of the permuted upper triangle
  SparsePattern upper_;      // of the permuted matrix
  std::vector<double> upper_values_;
  std::vector<double> residual_work_;
  std::vector<double> correction_work_;
  mutable bool references_are_current_ = false;
  mutable std::vector<double> pivot_references_;  // by place; the denominators of PivotRatio
};

}  // namespace catena
