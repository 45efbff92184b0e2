// UMFPACK behind plain types: multifrontal LU with true pivoting at every factorization, the robust fallback. Numeric
// factorization allocates. In a build without UMFPACK every call answers `unavailable`. For factorization.cpp.
// Source: T. Davis, "Algorithm 832: UMFPACK V4.3", ACM TOMS 30 (2004).
#pragma once

#include <memory>
#include <span>

#include "catena/linalg/kernels/factor_result.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

class UmfpackKernel {
 public:
  UmfpackKernel();
  ~UmfpackKernel();
  UmfpackKernel(UmfpackKernel&&) noexcept;
  UmfpackKernel& operator=(UmfpackKernel&&) noexcept;

  /// Orders the n x n pattern, n >= 1; structural singularity shows only in `factor`.
  FactorResult analyze(const SparsePattern& pattern);
  bool is_analyzed() const;

  /// `singular` carries no index: UMFPACK does not tell the column.
  FactorResult factor(const SparsePattern& pattern, std::span<const double> values);

  void solve(std::span<double> x);             ///< A X = B in place, x.size() / n right-hand sides
  void solve_transposed(std::span<double> x);  ///< A^T X = B in place

  double rcond() const;  ///< smallest over largest pivot magnitude of the row-scaled matrix

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace catena
