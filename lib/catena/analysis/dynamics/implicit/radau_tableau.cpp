// Coefficients of Radau IIA, order 5, and the real form of the basis in which the inverse of A is diagonal.
#include <cmath>

#include "catena/analysis/dynamics/implicit/radau.hpp"

namespace catena {
namespace {

using Matrix = RadauTableau::Matrix;

Matrix inverse_of(const Matrix& m) {
  Matrix result{};
  double determinant = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t c = (j + 1) % 3, d = (j + 2) % 3;
      result[j][i] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
    determinant += m[0][i] * (m[1][a] * m[2][b] - m[1][b] * m[2][a]);
  }
  for (auto& row : result) {
    for (double& value : row) value /= determinant;
  }
  return result;
}

/// A vector v with (m - x I) v = 0: a row of cofactors of a matrix of rank 2.
std::array<std::complex<double>, 3> null_vector(const Matrix& m, std::complex<double> x) {
  const auto entry = [&](std::size_t r, std::size_t c) { return m[r][c] - (r == c ? x : 0.0); };
  return {entry(0, 1) * entry(1, 2) - entry(0, 2) * entry(1, 1), entry(0, 2) * entry(1, 0) - entry(0, 0) * entry(1, 2),
          entry(0, 0) * entry(1, 1) - entry(0, 1) * entry(1, 0)};
}

// Eigenvalues of A^-1: roots of x^3 - 9 x^2 + 36 x - 60, the denominator of the method's stability function.
RadauTableau make() {
  const double s = std::sqrt(6.0), third = std::cbrt(3.0);
  RadauTableau table;
  table.c = {(4 - s) / 10, (4 + s) / 10, 1};
  table.a = {{{(88 - 7 * s) / 360, (296 - 169 * s) / 1800, (-2 + 3 * s) / 225},
              {(296 + 169 * s) / 1800, (88 + 7 * s) / 360, (-2 - 3 * s) / 225},
              {(16 - s) / 36, (16 + s) / 36, 1.0 / 9}}};
  table.inverse = inverse_of(table.a);
  table.real = 3 + third * third - third;
  table.pair_real = 3 - (third * third - third) / 2;
  table.pair_imaginary = std::sqrt(3.0) / 2 * (third * third + third);
  // Of the embedded formula with the weight 1/g of f(y): E. Hairer, G. Wanner, IV.8, (8.18).
  table.error = {-(13 + 7 * s) / 3, (-13 + 7 * s) / 3, -1.0 / 3};
  const auto real = null_vector(table.inverse, table.real);
  const auto pair = null_vector(table.inverse, {table.pair_real, -table.pair_imaginary});
  for (std::size_t i = 0; i < 3; ++i) table.basis[i] = {real[i].real(), pair[i].real(), pair[i].imag()};
  table.basis_inverse = inverse_of(table.basis);
  return table;
}

}  // namespace

const RadauTableau& radau_tableau() {
  static const RadauTableau table = make();
  return table;
}

}  // namespace catena
