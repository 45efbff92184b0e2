// Eigenvalues and eigenvectors of a symmetric tridiagonal matrix, in any unit.
//
//   T = tridiag(beta, alpha, beta)        T s = theta s        theta ascending, |s| = 1
//
// Eigen's iteration neglects an entry beside the diagonal once it is below eps sqrt(|alpha_k| + |alpha_k+1|), and asks
// its caller for entries near one: of compliances in m/N it neglects all, or loses digits. T is therefore multiplied by
// a power of two first, which changes no digit. Singular case: T = 0 has the unit vectors. Source: Golub and Van Loan,
// Matrix Computations, section 8.3.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>

namespace catena {

struct TridiagonalSpectrum {
  Eigen::VectorXd theta;
  Eigen::MatrixXd vectors;  ///< by columns
};

/// `beta` holds one entry fewer than `alpha`, or more, which do not count.
inline TridiagonalSpectrum tridiagonal_spectrum(std::span<const double> alpha, std::span<const double> beta) {
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
  return {unit * solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace catena
