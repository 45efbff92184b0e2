#include "catena/assembly/hessian_slots.hpp"

#include <cmath>

namespace catena {
namespace {

constexpr int largest = 6;
using Square = double[largest][largest];

// Cyclic Jacobi: A becomes diagonal, V collects the rotations. Source: Golub and Van Loan, section 8.5.
void diagonalise(Square& a, Square& v, int n) {
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0, on = 0;
    for (int p = 0; p < n; ++p) {
      on += a[p][p] * a[p][p];
      for (int q = 0; q < p; ++q) off += a[p][q] * a[p][q];
    }
    if (off <= 1e-32 * on) return;
    for (int p = 1; p < n; ++p) {
      for (int q = 0; q < p; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < n; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < n; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
        }
        for (int k = 0; k < n; ++k) {
          const double x = v[k][p], y = v[k][q];
          v[k][p] = c * x - s * y;
          v[k][q] = s * x + c * y;
        }
      }
    }
  }
}

}  // namespace

void keep_positive_part(double* lower, int size) {
  Square a{}, v{};
  for (int r = 0, k = 0; r < size; ++r) {
    v[r][r] = 1;
    for (int c = 0; c <= r; ++c, ++k) a[r][c] = a[c][r] = lower[k];
  }
  diagonalise(a, v, size);
  for (int r = 0, k = 0; r < size; ++r) {
    for (int c = 0; c <= r; ++c, ++k) {
      double sum = 0;
      for (int e = 0; e < size; ++e) sum += a[e][e] > 0 ? v[r][e] * a[e][e] * v[c][e] : 0;
      lower[k] = sum;
    }
  }
}

}  // namespace catena
