// How unequal the rows of a mechanism are, whatever the unit of length.
//
//   max(max_r a_r / min_r a_r over rows in metres, the same over rows in radians)
//
// a_r > 0: any number that a row has, as the diagonal of Phi_q M^-1 Phi_q^T. A row in metres and one in radians have no
// ratio; that of two of a kind is a number. 1 without rows; infinite where some a_r of a kind is zero and others not.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

namespace catena {

inline double row_spread(std::span<const double> a, std::span<const char> row_is_angle) {
  double least[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}, most[2] = {};
  for (std::size_t r = 0; r < a.size(); ++r) {
    const std::size_t kind = row_is_angle[r] ? 1 : 0;
    least[kind] = std::min(least[kind], a[r]);
    most[kind] = std::max(most[kind], a[r]);
  }
  double spread = 1;
  for (std::size_t kind = 0; kind < 2; ++kind) {
    if (most[kind] > 0) spread = std::max(spread, most[kind] / least[kind]);
  }
  return spread;
}

}  // namespace catena
