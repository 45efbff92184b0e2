// Norms in which metres and radians can be compared, so that a machine in millimetres and one in kilometres converge
// alike: lengths are divided by the scene's length scale, angles are taken as they are.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "catena/assembly/plan.hpp"

namespace catena {

/// Largest |x_k| over the columns of Phi_q, lengths divided by `length`. NaN if any entry is.
inline double column_norm(const Plan& plan, std::span<const double> x, double length) {
  double largest_length = 0, largest_angle = 0, sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const bool angle = plan.coordinate[k] % 3 == 2;
    double& largest = angle ? largest_angle : largest_length;
    largest = std::max(largest, std::abs(x[k]));
    sum += x[k];
  }
  if (!std::isfinite(sum)) return sum - sum;  // NaN
  return std::max(largest_length / length, largest_angle);
}

/// Largest residual over the rows, lengths divided by `length`. NaN if any entry is. `worst`: its row.
inline double row_norm(const Plan& plan, std::span<const double> r, double length, int* worst = nullptr) {
  double largest = 0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    const double size = std::abs(r[k]) / (plan.row_is_angle[k] ? 1.0 : length);
    if (!std::isfinite(size)) {
      if (worst) *worst = static_cast<int>(k);
      return size - size;
    }
    if (size > largest) {
      largest = size;
      if (worst) *worst = static_cast<int>(k);
    }
  }
  return largest;
}

}  // namespace catena
