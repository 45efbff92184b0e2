// KLU behind plain types: LU factors of P A Q in block triangular form, R^-1 A D = L U per diagonal block (D: units of
// the columns, R: the largest magnitude of each row of A D where the pivots were chosen). Only the diagonal blocks are
// factored; fill-in never leaves them. For factorization.cpp.
//
// A refactorization keeps the pivot order and R of the last full factorization and allocates nothing: KLU's own scaling
// reads the matrix once more by rows at every call, and divides; here scaling is one product an entry. It is accepted
// when all entries of L stay below a limit; since rows are scaled to about one, L can only grow below a small pivot, so
// that in the usual case the check reads the n pivots and nothing else.
// Source: T. Davis, E. Palamadai Natarajan, "Algorithm 907: KLU", ACM TOMS 37 (2010).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/kernels/lanes.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

class KluKernel {
 public:
  KluKernel();
  ~KluKernel();
  KluKernel(KluKernel&&) noexcept;
  KluKernel& operator=(KluKernel&&) noexcept;

  /// Orders the n x n pattern, n >= 1; row_of_column is a full matching of it. (KLU's own search for one is quadratic
  /// on some chains, see matching.hpp.)
  FactorResult analyze(const SparsePattern& pattern, std::span<const int> row_of_column);
  /// Units of the n columns, positive: pivots are those of A D. Without them D = I. For the next `factor`.
  void set_column_units(std::span<const double> units);

  /// Full factorization with new pivots: the diagonal is preferred unless smaller than pivot_tolerance times the
  /// column's largest entry (1: strict partial pivoting). Allocates. After a failure no factors are held.
  FactorResult factor(const SparsePattern& pattern, std::span<const double> values, double pivot_tolerance);

  /// Factorization with the kept pivots, no allocation. False: the pivots no longer suit these values (growth, or a
  /// pivot that vanished or is not finite, or rows that have outgrown their scale), `factor` must decide.
  bool refactor(const SparsePattern& pattern, std::span<const double> values);

  bool has_factors() const;

  void solve(std::span<double> x);             ///< A X = B in place, x.size() / n right-hand sides
  bool solves_in_lanes() const;                ///< all blocks are small
  void solve(std::span<Lanes> x);              ///< four right-hand sides at once, where it does
  void solve_transposed(std::span<double> x);  ///< A^T X = B in place

  double rcond() const;                       ///< smallest over largest pivot magnitude of R^-1 A D
  std::span<const int> block_starts() const;  ///< size blocks + 1: places in the permuted matrix
  std::span<const int> column_order() const;  ///< column at every place of the permuted matrix
  std::span<const int> row_order() const;     ///< row at every place; within a block before pivoting
  std::span<const double> row_scale() const;  ///< by which rows are multiplied, chosen at the last factor()
  std::span<const int> pivot_rows() const;    ///< row at every place after pivoting
  std::span<const double> pivots() const;     ///< pivot of every place, of R^-1 A D

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace catena
