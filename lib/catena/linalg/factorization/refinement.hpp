// Iterative refinement x += A^-1 (b - A x) with the solver and the residual as callables: the factored matrix may be a
// regularised neighbour of the true one, the residual belongs to the true one. Converges linearly with the factor
// |I - F^-1 A|, F the factored matrix; stops by itself once nothing is gained any more.
#pragma once

#include <cstddef>
#include <span>

namespace catena {

struct RefinementLimits {
  double tolerance = 0;  ///< stop as soon as the residual's size is at most this
  int max_steps = 3;
  double least_progress = 0.5;  ///< stop when a step leaves more than this fraction of the residual
};

struct Refinement {
  double residual = 0;  ///< size of the last residual, in the caller's measure
  int steps = 0;        ///< corrections that were kept
  bool met = false;     ///< the residual is within the tolerance
};

/// Refines x in place. solve(v): v := F^-1 v. residual(x, r): writes b - A x into r, returns its size (>= 0, in any
/// measure). `work` and `correction`: as long as x. A correction that makes the residual larger is taken back.
template <class Solve, class Residual>
Refinement refine(Solve&& solve, Residual&& residual, std::span<double> x, std::span<double> work,
                  std::span<double> correction, const RefinementLimits& limits) {
  Refinement result;
  result.residual = residual(std::span<const double>(x), work);
  while (!(result.residual <= limits.tolerance) && result.steps < limits.max_steps) {
    for (std::size_t i = 0; i < x.size(); ++i) correction[i] = work[i];
    solve(correction);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction[i];
    const double refined = residual(std::span<const double>(x), work);
    if (!(refined < result.residual)) {
      for (std::size_t i = 0; i < x.size(); ++i) x[i] -= correction[i];
      break;
    }
    const bool slow = refined > limits.least_progress * result.residual;
    result.residual = refined;
    ++result.steps;
    if (slow) break;
  }
  result.met = result.residual <= limits.tolerance;
  return result;
}

}  // namespace catena
