// Eigenvalues and eigenvectors of a symmetric tridiagonal matrix, in any unit.
//
//   T = tridiag(beta, alpha, beta)        T s = theta s        theta ascending, |s| = 1
//
// Eigen's iteration neglects an entry beside the diagonal once it is below eps sqrt(|alpha_k| + |alpha_k+1|), and asks
// its caller for entries near one: of compliances in m/N it neglects all, or loses digits. T is therefore multiplied by
// a power of two first, which changes no digit. Singular case: T = 0 has the unit vectors. Source: Golub and Van Loan,
// Matrix Computations, section 8.3.
#pragma once

#include <span>
#include <vector>

namespace catena {

struct TridiagonalSpectrum {
  std::vector<double> theta;
  std::vector<double> vectors;  ///< one after the other, each as long as theta

  std::span<const double> vector(std::size_t k) const {
    return std::span(vectors).subspan(k * theta.size(), theta.size());
  }
};

/// `beta` holds one entry fewer than `alpha`, or more, which do not count.
TridiagonalSpectrum tridiagonal_spectrum(std::span<const double> alpha, std::span<const double> beta);

}  // namespace catena
