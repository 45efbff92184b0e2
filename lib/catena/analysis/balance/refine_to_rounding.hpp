// A x = b by factors of a neighbour of A, refined with A itself until rounding ends the gain.
//
//   x := F^-1 b, then x += F^-1 (b - A x) while corrections become shorter, in the metric diag(weight) of the places
//
// Only places are measured: multipliers follow from them, and those of rows that depend on each other may go on moving.
// Ends too where the next correction, extrapolated from the last two, is rounding: half an epsilon of the solution.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {

/// Solves for the right-hand side `given`. solve(v): v := F^-1 v. multiply(x, y): y := A x. `correction`: work. Returns
/// the last correction as a part of the solution: what is left is rounding x condition, or F is of another matrix.
template <class Solve, class Multiply>
double refine_to_rounding(std::span<const double> weight, std::span<const double> given, std::span<double> x,
                          std::span<double> correction, Solve&& solve, Multiply&& multiply) {
  const auto size_of = [&](std::span<const double> v) {
    double sum = 0;
    for (std::size_t c = 0; c < weight.size(); ++c) sum += weight[c] * v[c] * v[c];
    return std::sqrt(sum);
  };
  std::copy(given.begin(), given.end(), x.begin());
  solve(x);
  double before = size_of(x);
  // Corrections halve at least: some fifty end it.
  for (;;) {
    multiply(std::span<const double>(x), correction);
    for (std::size_t i = 0; i < x.size(); ++i) correction[i] = given[i] - correction[i];
    solve(correction);
    const double now = size_of(correction);
    if (!(now < thresholds::least_gain * before)) return now > 0 ? now / size_of(x) : now;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction[i];
    if (now * (now / before) <= std::numeric_limits<double>::epsilon() / 2 * size_of(x)) return now / size_of(x);
    before = now;
  }
}

}  // namespace catena
