// Eigenvalues theta of largest size of a symmetric operator on the null space of Phi_q, by Lanczos' method.
//
//   A^-1 B v = theta v      symmetric in the metric G: x^T G y
//
// Small oscillations: A = K - sigma M, B = G = M; buckling: A = G = K, B = -K'. All vectors are kept orthogonal (twice
// Gram-Schmidt), so that no eigenvalue appears twice by rounding. Where the space that the start spans is exhausted, or
// a vector is lost in rounding, the iteration goes on with a new vector. Memory: one vector a step. A mode counts as
// settled when its residual is below 1e-11 of its theta (1e-14 of the largest theta where that is more). Sources: B.
// Parlett, The Symmetric Eigenvalue Problem, chapter 13; T. Ericsson, A. Ruhe, Math. Comp. 35 (1980).
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

namespace catena {

/// The problem as Lanczos' method needs it; vectors over the columns of Phi_q.
class SpectralOperator {
 public:
  virtual ~SpectralOperator() = default;
  virtual int columns() const = 0;
  /// Sizes of the components of a start vector: as a typical mode has them.
  virtual std::span<const double> typical() const = 0;
  virtual void metric(std::span<const double> v, std::span<double> Gv) = 0;
  /// v := A^-1 B v, in the null space of Phi_q.
  virtual void invert(std::span<double> v) = 0;
  /// Brings v into the null space of Phi_q.
  virtual void project(std::span<double> v) = 0;
};

class Lanczos {
 public:
  /// Vectors that are always allowed, and that `wanted` eigenvalues may take.
  static constexpr int least_vectors = 300;
  static int most_vectors(int wanted) { return std::max(least_vectors, 3 * wanted + 60); }

  /// Positions of the eigenvalues that are wanted among ascending ones; none while there are too few.
  using Choice = std::function<std::vector<int>(std::span<const double> theta)>;

  /// `locked`: eigenvectors known already, orthonormal in the metric; all others are orthogonal to them.
  Lanczos(SpectralOperator& op, std::vector<std::vector<double>> locked = {});

  /// Iterates until the chosen eigenvalues have settled, the space is exhausted or `most` vectors are reached.
  /// True if the chosen eigenvalues have settled. False from `go_on` stops.
  bool run(const Choice& choose, int most, const std::function<bool()>& go_on = {});

  /// In parts, for who judges alone when to stop. Begins with A^-1 B of the start vector in place of its projection.
  bool begin_inverted();
  /// One step; `last`: without a vector for the next one. False where numbers are no longer finite.
  bool advance(bool last);
  /// theta() and vector() after the steps made so far.
  void find_spectrum();
  /// Whether the last step left nothing of the space that the start spans.
  bool is_complete() const { return !beta_.empty() && beta_.back() == 0; }

  /// Whether every direction of the null space was found: then the spectrum is complete.
  bool exhausted() const { return exhausted_; }
  int steps() const { return static_cast<int>(alpha_.size()); }
  /// Ascending.
  std::span<const double> theta() const { return theta_; }
  /// Eigenvector of theta()[k], of length 1 in the metric.
  std::vector<double> vector(int k) const;

 private:
  std::vector<double> random_vector();
  bool add_new_vector();
  bool clean(std::vector<double>& v);
  void orthogonalise(std::vector<double>& w, double* last);
  double length(const std::vector<double>& w);
  bool update_spectrum(const Choice& choose);
  std::vector<double> combine(std::span<const double> coefficients) const;

  SpectralOperator& op_;
  std::size_t size_;
  std::vector<std::vector<double>> locked_, basis_;
  std::vector<double> alpha_, beta_, work_;
  std::vector<double> theta_, coefficients_;  // eigenvectors of the tridiagonal matrix, one after the other
  double scale_ = 0;                          // largest entry of the tridiagonal matrix
  bool exhausted_ = false;
  unsigned seed_ = 12345;
};

}  // namespace catena
