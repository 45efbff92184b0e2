// A x = b for a square, unsymmetric sparse matrix whose values change and whose pattern does not: `analyze` once,
// `factorize` at every change of the values, `solve` as often as wanted. After the first round neither factorize nor
// solve allocates, unless pivots have to be chosen anew or a fallback takes over.
//
// KLU works on the diagonal blocks of the block triangular form; their pivots tell which part of a mechanism nears a
// singular position. Entry k of `values` belongs to entry k of the pattern.
// Bad values (NaN) outside the diagonal blocks are not looked for in `factorize`; they come out in the solution.
// One object serves one thread at a time; different objects are independent.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/base/counters.hpp"
#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/kernels/kernel_info.hpp"
#include "catena/linalg/kernels/klu_kernel.hpp"
#include "catena/linalg/kernels/umfpack_kernel.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

/// When solve_checked accepts a solution.
struct SolveCheck {
  double tolerance = 1e-13;  ///< for max_i |b - A x|_i / (sum_j |a_ij| * max|x| + |b_i|); blind to the rows' scales
  int max_refinements = 2;   ///< for each kernel tried
};

struct [[nodiscard]] CheckedSolve {
  FactorStatus status = FactorStatus::ok;
  double residual = 0;     ///< of the solution returned, in the measure of SolveCheck
  int refinements = 0;     ///< corrections added
  bool fell_back = false;  ///< a safer kernel took over; it stays in use until the next `factorize`

  bool ok() const { return status == FactorStatus::ok; }
};

/// One pivot of the scaled matrix: columns in their units, the largest magnitude of every row 1 where pivots were last
/// chosen.
struct PivotInfo {
  double magnitude = 0;
  int column = -1;  ///< in the caller's numbering
};

/// How far a diagonal block is from a singular matrix. Both carry the sign of its determinant, up to a factor that
/// never changes, and vanish where the block is singular; the pivot may be small elsewhere too, the determinant is
/// smooth.
struct BlockMargin {
  static constexpr int largest_block = 64;
  double pivot = 0;        ///< the smallest, of the scaled matrix
  double determinant = 0;  ///< of the scaled block; of blocks larger than largest_block the pivot again
};

class Factorization {
 public:
  /// Orders the matrix. `pattern` must be square (std::invalid_argument otherwise) and is copied.
  /// singular: the pattern alone excludes a solution; structural_rank(), unmatched_rows() and unmatched_columns() tell
  /// more. unavailable: `kernel` is not in this build or serves symmetric or rectangular matrices only.
  FactorResult analyze(const SparsePattern& pattern, Kernel kernel, Counters& counters);

  /// Units of the columns, positive, size() of them, from the next choice of pivots on; after `analyze`, which forgets
  /// them. Pivots, margins and rcond() are those of A D; solutions are those of A.
  void set_column_units(std::span<const double> units);

  /// Factors the matrix with these values; the pivots of the previous call are kept while they suit.
  FactorResult factorize(std::span<const double> values, Counters& counters);

  /// A X = B in place; x holds one or several right-hand sides, one after the other (size() values each).
  /// Throws std::logic_error without a valid factorization.
  void solve(std::span<double> x, Counters& counters);
  /// Whether factors at hand can solve for several right-hand sides side by side: KLU's, where all blocks are small.
  bool solves_in_lanes() const { return factorized_ && !umfpack_in_use_ && klu_.solves_in_lanes(); }
  /// The same for four right-hand sides at once, where that is so; throws std::logic_error elsewhere.
  void solve(std::span<Lanes> x, Counters& counters);
  /// A^T X = B in place.
  void solve_transposed(std::span<double> x, Counters& counters);

  /// As `solve` for one right-hand side, but the residual is checked with the `values` given to `factorize`: above the
  /// tolerance the solution is refined, then KLU chooses new pivots, then, with Kernel::automatic, UMFPACK takes over
  /// (counted as a fallback; KLU with strict partial pivoting where UMFPACK is not compiled in).
  CheckedSolve solve_checked(std::span<const double> values, std::span<double> x, Counters& counters,
                             const SolveCheck& check = {});

  int size() const { return pattern_.columns; }
  const SparsePattern& pattern() const { return pattern_; }
  bool is_factorized() const { return factorized_; }
  /// klu or umfpack: the kernel of the next solve.
  Kernel kernel_in_use() const { return umfpack_in_use_ ? Kernel::umfpack : Kernel::klu; }

  /// Smallest over largest pivot magnitude of the scaled matrix: a crude reciprocal condition number, 0 without a
  /// valid factorization.
  double rcond() const;

  /// Rank that the pattern allows; size() when a full matching of rows and columns exists. UMFPACK forced: size().
  int structural_rank() const { return form_.structural_rank; }
  /// Rows and columns left over by a maximal matching: empty unless structurally singular.
  const std::vector<int>& unmatched_rows() const { return form_.unmatched_rows; }
  const std::vector<int>& unmatched_columns() const { return form_.unmatched_columns; }

  /// Block triangular form: number of diagonal blocks, size of the largest, and the block of every column and row.
  /// Blocks are numbered in the order of the upper triangular form: the last one is solved first. With UMFPACK forced
  /// there is one block, for a structurally singular pattern none.
  int blocks() const { return form_.blocks; }
  int largest_block() const { return form_.largest_block; }
  std::span<const int> block_of_column() const { return form_.block_of_column; }
  std::span<const int> block_of_row() const { return form_.block_of_row; }

  /// Smallest pivot of a block. KLU only: throws std::logic_error while UMFPACK is in use or nothing is factored.
  PivotInfo smallest_pivot(int block) const;

  /// How far every diagonal block is from a singular matrix, with the sign of its determinant up to a factor that never
  /// changes between factorizations: a different sign shows that a block has passed a singular matrix in between. Empty
  /// while UMFPACK is in use. No allocation after the first call.
  std::span<const BlockMargin> block_margins();

  /// A failed result in a sentence for a report.
  std::string describe(const FactorResult& result) const;

 private:
  // KLU keeps the diagonal of its ordering as pivot, which keeps fill-in low, unless another candidate is a thousand
  // times larger (its own default); strict: the largest candidate always.
  static constexpr double usual_pivot_tolerance = 1e-3;
  static constexpr double strict_pivot_tolerance = 1.0;

  FactorResult factor_anew(std::span<const double> values, double pivot_tolerance, Counters& counters);
  FactorResult factor_by_umfpack(std::span<const double> values, Counters& counters);
  FactorResult use_safer_kernel(std::span<const double> values, int& stage, CheckedSolve& outcome, Counters& counters);
  double refine(std::span<const double> values, std::span<double> x, const SolveCheck& check, CheckedSolve& outcome,
                Counters& counters);
  double residual(std::span<const double> values, std::span<const double> x);
  void solve_by_kernel_in_use(std::span<double> x);
  void require_factors() const;
  void read_block_form();
  void find_parities();

  SparsePattern pattern_;
  Kernel kernel_ = Kernel::automatic;
  KluKernel klu_;
  UmfpackKernel umfpack_;
  bool factorized_ = false;
  bool umfpack_in_use_ = false;
  bool pivots_are_fresh_ = false;
  /// Block triangular form.
  struct {
    int structural_rank = 0, blocks = 0, largest_block = 0;
    std::vector<int> block_of_column, block_of_row, block_start;
    std::vector<int> unmatched_rows, unmatched_columns;
  } form_;
  bool parities_are_current_ = false;
  std::vector<signed char> parities_;  // of the pivoting within every block
  std::vector<BlockMargin> margins_;
  bool margins_are_current_ = false;
  std::vector<int> place_of_row_, cycle_;
  // Rows are scaled anew with every choice of pivots; margins stay those in the scale of the first one.
  std::vector<double> first_scale_;      // per row
  std::vector<double> rescaling_;        // per place: first scale / present one; empty: the same
  std::vector<double> right_hand_side_;  // these three for solve_checked only, allocated at its first call
  std::vector<double> correction_;
  std::vector<double> row_scale_;
};

}  // namespace catena
