// Dense algebra of references: Eigen's decompositions, compiled once for all tests.
//
// A test that names Eigen's classes compiles them for itself, in every unit and without optimisation: half of the time
// of such a unit. Here they stand behind functions of plain matrices, in double and in long double (64 bits of
// mantissa). Nothing of this is the library's: what its results are compared with shares no code with it.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>
#include <vector>

namespace catena::testing {

template <class T>
using DenseMatrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <class T>
using DenseVector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

/// P A Q = L U of a square or rectangular matrix, with full pivoting.
template <class T>
class ReferenceFactors {
 public:
  explicit ReferenceFactors(const DenseMatrix<T>& a);

  DenseVector<T> solve(const DenseVector<T>& b) const;
  DenseMatrix<T> solve_all(const DenseMatrix<T>& b) const;
  DenseMatrix<T> inverse() const;
  /// Columns that A takes to zero.
  DenseMatrix<T> kernel() const;
  T determinant() const;
  /// 1 / condition, estimated in the norm of columns.
  T reciprocal_condition() const;

 private:
  struct Lu;
  std::shared_ptr<const Lu> lu_;
};

/// The rows of a matrix as they depend on each other, by a QR factorization of its transpose with pivots: a row counts
/// while its pivot is above `threshold` of the largest.
template <class T>
class DenseRows {
 public:
  DenseRows(const DenseMatrix<T>& rows, T threshold);

  Eigen::Index rank() const;
  /// The pivot of the last row that counts; 1 where none does.
  T least_pivot() const;
  /// Numbers of the rows that count, by falling pivots.
  std::vector<Eigen::Index> independent() const;
  /// Orthonormal columns of the vectors that all rows take to zero.
  DenseMatrix<T> null_space() const;
  /// Multipliers of the independent rows, zero for others, with rows^T m closest to the given vector.
  DenseVector<T> multipliers(const DenseVector<T>& sum) const;

 private:
  struct Qr;
  std::shared_ptr<const Qr> qr_;
};

/// Of all x with the least |A x - b|, the shortest; singular values below `threshold` of the largest count as zero.
template <class T>
class LeastSquares {
 public:
  explicit LeastSquares(const DenseMatrix<T>& a, T threshold = 0);
  DenseVector<T> solve(const DenseVector<T>& b) const;

 private:
  struct Orthogonal;
  std::shared_ptr<const Orthogonal> orthogonal_;
};

template <class T>
DenseVector<T> solve(const DenseMatrix<T>& a, const DenseVector<T>& b) {
  return ReferenceFactors<T>(a).solve(b);
}

/// Of a symmetric matrix, ascending.
template <class T>
DenseVector<T> symmetric_eigenvalues(const DenseMatrix<T>& a);

/// Of K x = value M x, ascending; K symmetric (its mean with the transpose is taken), M positive definite.
template <class T>
std::vector<T> generalized_eigenvalues(const DenseMatrix<T>& k, const DenseMatrix<T>& m);

/// Of any square matrix.
template <class T>
struct DenseSpectrum {
  std::vector<std::complex<T>> values;
  DenseMatrix<std::complex<T>> vectors;  ///< columns
};
template <class T>
std::vector<std::complex<T>> eigenvalues(const DenseMatrix<T>& a);
template <class T>
DenseSpectrum<T> spectrum(const DenseMatrix<T>& a);

/// A = U diag(values) V^T, values falling.
struct SingularValues {
  Eigen::MatrixXd u, v;
  Eigen::VectorXd values;

  /// How many are above `threshold` of the largest.
  Eigen::Index rank(double threshold) const { return (values.array() > threshold * values[0]).count(); }
  /// The shortest x with the least |A x - b| for the `count` largest values.
  Eigen::VectorXd solve(const Eigen::VectorXd& b, Eigen::Index count) const {
    return v.leftCols(count) * (u.leftCols(count).transpose() * b).cwiseQuotient(values.head(count));
  }
};
/// Full U and V, or thin ones.
SingularValues singular_values(const Eigen::MatrixXd& a, bool full = false);

}  // namespace catena::testing
