// A x = b and A^T x = b for a small matrix that is stored in full: R P A = L U, R the scales of the rows, P their
// order.
//
//   begin(n), fill the entries, factorize();   then as often as wanted solve() and solve_transposed()
//
// Every column takes the largest entry of the scaled rows that are left as its pivot. Right-hand sides are numbers or
// several in lanes. Nothing allocates for matrices no larger than earlier ones. Singular case: a pivot that is zero or
// not finite; rcond() is small nearby. Source: G. Golub, C. Van Loan, Matrix Computations, section 3.4.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace catena {

class DenseFactors {
 public:
  /// The entries of a matrix of n rows, all zero, row after row: fill them.
  std::span<double> begin(int n) {
    n_ = static_cast<std::size_t>(n);
    entries_.assign(n_ * n_, 0.0);
    scale_.resize(n_);
    order_.resize(n_);
    return entries_;
  }
  /// False where a pivot is zero or not finite.
  bool factorize() {
    for (std::size_t i = 0; i < n_; ++i) {
      double largest = 0;
      for (std::size_t j = 0; j < n_; ++j) largest = std::max(largest, std::abs(row(i)[j]));
      scale_[i] = largest > 0 ? 1 / largest : 1;
      for (std::size_t j = 0; j < n_; ++j) row(i)[j] *= scale_[i];
      order_[i] = i;
    }
    smallest_ = largest_ = 0;
    for (std::size_t k = 0; k < n_; ++k) {
      if (!eliminate(k)) return false;
    }
    return true;
  }
  /// Smallest over largest pivot.
  double rcond() const { return largest_ > 0 ? smallest_ / largest_ : 0; }

  /// `b` and `x` must not overlap.
  template <class V>
  void solve(std::span<const V> b, std::span<V> x) const {
    for (std::size_t k = 0; k < n_; ++k) {
      V sum = scale_[order_[k]] * b[order_[k]];
      for (std::size_t j = 0; j < k; ++j) sum -= row(k)[j] * x[j];
      x[k] = sum;
    }
    for (std::size_t k = n_; k-- > 0;) {
      V sum = x[k];
      for (std::size_t j = k + 1; j < n_; ++j) sum -= row(k)[j] * x[j];
      x[k] = row(k)[k] * sum;
    }
  }
  /// A^T x = b; b is overwritten.
  template <class V>
  void solve_transposed(std::span<V> b, std::span<V> x) const {
    for (std::size_t k = 0; k < n_; ++k) {
      b[k] = row(k)[k] * b[k];
      for (std::size_t j = k + 1; j < n_; ++j) b[j] -= row(k)[j] * b[k];
    }
    for (std::size_t k = n_; k-- > 0;) {
      for (std::size_t j = 0; j < k; ++j) b[j] -= row(k)[j] * b[k];
      x[order_[k]] = scale_[order_[k]] * b[k];
    }
  }

 private:
  double* row(std::size_t k) { return entries_.data() + k * n_; }
  const double* row(std::size_t k) const { return entries_.data() + k * n_; }
  /// Column k; its pivot's inverse comes onto the diagonal.
  bool eliminate(std::size_t k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < n_; ++i) {
      if (std::abs(row(i)[k]) > std::abs(row(best)[k])) best = i;
    }
    const double pivot = row(best)[k], size = std::abs(pivot);
    if (!(size > 0) || !std::isfinite(size)) return false;
    smallest_ = k == 0 ? size : std::min(smallest_, size);
    largest_ = std::max(largest_, size);
    if (best != k) {
      std::swap_ranges(row(k), row(k) + n_, row(best));
      std::swap(order_[k], order_[best]);
    }
    row(k)[k] = 1 / pivot;
    for (std::size_t i = k + 1; i < n_; ++i) {
      const double factor = row(i)[k];
      if (factor == 0) continue;
      row(i)[k] = factor * row(k)[k];
      for (std::size_t j = k + 1; j < n_; ++j) row(i)[j] -= row(i)[k] * row(k)[j];
    }
    return true;
  }

  std::size_t n_ = 0;
  std::vector<double> entries_, scale_;  // L below the diagonal, inverse pivots on it, U above
  std::vector<std::size_t> order_;
  double smallest_ = 0, largest_ = 0;
};

}  // namespace catena
