#include "catena/analysis/spectrum/tridiagonal.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace catena {

TridiagonalSpectrum tridiagonal_spectrum(std::span<const double> alpha, std::span<const double> beta) {
  double largest = 0;
  for (std::size_t k = 0; k < alpha.size(); ++k) {
    largest = std::max(largest, std::abs(alpha[k]));
    if (k + 1 < alpha.size()) largest = std::max(largest, std::abs(beta[k]));
  }
  const double unit = largest > 0 && std::isfinite(largest) ? std::ldexp(1.0, std::ilogb(largest)) : 1;
  const auto n = static_cast<Eigen::Index>(alpha.size());
  Eigen::VectorXd diagonal(n), beside(std::max<Eigen::Index>(n - 1, 0));
  for (Eigen::Index k = 0; k < n; ++k) diagonal[k] = alpha[static_cast<std::size_t>(k)] / unit;
  for (Eigen::Index k = 0; k + 1 < n; ++k) beside[k] = beta[static_cast<std::size_t>(k)] / unit;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside);
  TridiagonalSpectrum result;
  for (Eigen::Index k = 0; k < n; ++k) result.theta.push_back(unit * solver.eigenvalues()[k]);
  result.vectors.assign(solver.eigenvectors().data(), solver.eigenvectors().data() + n * n);
  return result;
}

}  // namespace catena
