#include "references/dense.hpp"

#include <Eigen/Dense>
#include <optional>

namespace catena::testing {

template <class T>
struct ReferenceFactors<T>::Lu {
  Eigen::FullPivLU<DenseMatrix<T>> factors;
};

template <class T>
ReferenceFactors<T>::ReferenceFactors(const DenseMatrix<T>& a) : lu_(new Lu{Eigen::FullPivLU<DenseMatrix<T>>(a)}) {}

template <class T>
DenseVector<T> ReferenceFactors<T>::solve(const DenseVector<T>& b) const {
  return lu_->factors.solve(b);
}

template <class T>
DenseMatrix<T> ReferenceFactors<T>::solve_all(const DenseMatrix<T>& b) const {
  return lu_->factors.solve(b);
}

template <class T>
DenseMatrix<T> ReferenceFactors<T>::inverse() const {
  return lu_->factors.inverse();
}

template <class T>
DenseMatrix<T> ReferenceFactors<T>::kernel() const {
  return lu_->factors.kernel();
}

template <class T>
T ReferenceFactors<T>::determinant() const {
  return lu_->factors.determinant();
}

template <class T>
T ReferenceFactors<T>::reciprocal_condition() const {
  return lu_->factors.rcond();
}

template <class T>
struct DenseRows<T>::Qr {
  Eigen::Index rows, unknowns;
  // Absent without rows: Eigen's pivoting reads the norms of columns that an empty matrix does not have.
  std::optional<Eigen::ColPivHouseholderQR<DenseMatrix<T>>> factors;
};

template <class T>
DenseRows<T>::DenseRows(const DenseMatrix<T>& rows, T threshold) {
  const auto qr = std::make_shared<Qr>(Qr{rows.rows(), rows.cols(), std::nullopt});
  if (rows.size() > 0) qr->factors.emplace().setThreshold(threshold).compute(rows.transpose());
  qr_ = qr;
}

template <class T>
Eigen::Index DenseRows<T>::rank() const {
  return qr_->factors ? qr_->factors->rank() : 0;
}

template <class T>
T DenseRows<T>::least_pivot() const {
  return rank() > 0 ? std::abs(qr_->factors->matrixR()(rank() - 1, rank() - 1)) : T(1);
}

template <class T>
std::vector<Eigen::Index> DenseRows<T>::independent() const {
  if (!qr_->factors) return {};
  const auto& order = qr_->factors->colsPermutation().indices();
  return {order.data(), order.data() + rank()};
}

template <class T>
DenseMatrix<T> DenseRows<T>::null_space() const {
  DenseMatrix<T> all = DenseMatrix<T>::Identity(qr_->unknowns, qr_->unknowns);
  if (qr_->factors) all = qr_->factors->householderQ() * all;
  return all.rightCols(qr_->unknowns - rank());
}

template <class T>
DenseVector<T> DenseRows<T>::multipliers(const DenseVector<T>& sum) const {
  return qr_->factors ? DenseVector<T>(qr_->factors->solve(sum)) : DenseVector<T>::Zero(qr_->rows);
}

template <class T>
struct LeastSquares<T>::Orthogonal {
  Eigen::Index unknowns;
  // Absent for an empty matrix, as in DenseRows.
  std::optional<Eigen::CompleteOrthogonalDecomposition<DenseMatrix<T>>> factors;
};

template <class T>
LeastSquares<T>::LeastSquares(const DenseMatrix<T>& a, T threshold) {
  const auto orthogonal = std::make_shared<Orthogonal>(Orthogonal{a.cols(), std::nullopt});
  if (a.size() > 0) {
    auto& factors = orthogonal->factors.emplace();
    if (threshold > 0) factors.setThreshold(threshold);
    factors.compute(a);
  }
  orthogonal_ = orthogonal;
}

template <class T>
DenseVector<T> LeastSquares<T>::solve(const DenseVector<T>& b) const {
  return orthogonal_->factors ? DenseVector<T>(orthogonal_->factors->solve(b))
                              : DenseVector<T>::Zero(orthogonal_->unknowns);
}

template <class T>
DenseVector<T> symmetric_eigenvalues(const DenseMatrix<T>& a) {
  return Eigen::SelfAdjointEigenSolver<DenseMatrix<T>>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

template <class T>
std::vector<T> generalized_eigenvalues(const DenseMatrix<T>& k, const DenseMatrix<T>& m) {
  const DenseMatrix<T> mean = (k + k.transpose()) / 2;
  const Eigen::GeneralizedSelfAdjointEigenSolver<DenseMatrix<T>> solver(mean, m, Eigen::EigenvaluesOnly);
  return {solver.eigenvalues().data(), solver.eigenvalues().data() + solver.eigenvalues().size()};
}

template <class T>
std::vector<std::complex<T>> eigenvalues(const DenseMatrix<T>& a) {
  const Eigen::EigenSolver<DenseMatrix<T>> solver(a, false);
  return {solver.eigenvalues().data(), solver.eigenvalues().data() + a.rows()};
}

template <class T>
DenseSpectrum<T> spectrum(const DenseMatrix<T>& a) {
  const Eigen::EigenSolver<DenseMatrix<T>> solver(a);
  return {{solver.eigenvalues().data(), solver.eigenvalues().data() + a.rows()}, solver.eigenvectors()};
}

SingularValues singular_values(const Eigen::MatrixXd& a, bool full) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(
      a, full ? Eigen::ComputeFullU | Eigen::ComputeFullV : Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

template class ReferenceFactors<double>;
template class ReferenceFactors<long double>;
template class DenseRows<double>;
template class DenseRows<long double>;
template class LeastSquares<double>;
template class LeastSquares<long double>;
template DenseVector<double> symmetric_eigenvalues(const DenseMatrix<double>&);
template DenseVector<long double> symmetric_eigenvalues(const DenseMatrix<long double>&);
template std::vector<double> generalized_eigenvalues(const DenseMatrix<double>&, const DenseMatrix<double>&);
template std::vector<long double> generalized_eigenvalues(const DenseMatrix<long double>&,
                                                          const DenseMatrix<long double>&);
template std::vector<std::complex<long double>> eigenvalues(const DenseMatrix<long double>&);
template DenseSpectrum<long double> spectrum(const DenseMatrix<long double>&);

}  // namespace catena::testing
