// The careful solve: residual check, refinement, and the ladder of safer kernels.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "catena/linalg/factorization/factorization.hpp"

namespace catena {
namespace {

enum Stage { as_factored, new_pivots, fallback, exhausted };

double largest_magnitude(std::span<const double> x) {
  double largest = 0;
  for (double value : x) {
    if (!std::isfinite(value)) return value;  // infinite or not a number: no comparison may hide it
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

}  // namespace

/// Leaves b - A x in correction_ and returns its size in the measure of SolveCheck; not finite when x is not.
double Factorization::residual(std::span<const double> values, std::span<const double> x) {
  std::copy(right_hand_side_.begin(), right_hand_side_.end(), correction_.begin());
  std::fill(row_scale_.begin(), row_scale_.end(), 0.0);
  for (int j = 0; j < size(); ++j) {
    for (int k = pattern_.column_start[j]; k < pattern_.column_start[j + 1]; ++k) {
      const int row = pattern_.row_index[k];
      correction_[row] -= values[k] * x[j];
      row_scale_[row] += std::abs(values[k]);
    }
  }
  const double x_size = largest_magnitude(x);
  double worst = 0;
  for (std::size_t i = 0; i < correction_.size(); ++i) {
    const double magnitude = std::abs(correction_[i]);
    if (!std::isfinite(magnitude)) return magnitude;
    if (magnitude > 0) worst = std::max(worst, magnitude / (row_scale_[i] * x_size + std::abs(right_hand_side_[i])));
  }
  return worst;
}

/// Solves for right_hand_side_ with the factors at hand and refines while that helps.
double Factorization::refine(std::span<const double> values, std::span<double> x, const SolveCheck& check,
                             CheckedSolve& outcome, Counters& counters) {
  std::copy(right_hand_side_.begin(), right_hand_side_.end(), x.begin());
  ++counters.solves;
  solve_by_kernel_in_use(x);
  double error = residual(values, x);
  for (int step = 0; step < check.max_refinements && error > check.tolerance && std::isfinite(error); ++step) {
    ++counters.solves;
    ++outcome.refinements;
    solve_by_kernel_in_use(correction_);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction_[i];
    const double refined = residual(values, x);
    if (!(refined < 0.5 * error)) return refined;
    error = refined;
  }
  return error;
}

/// The next rung of the ladder: new pivots for KLU, then the fallback. `stage` says which rung was reached.
FactorResult Factorization::use_safer_kernel(std::span<const double> values, int& stage, CheckedSolve& outcome,
                                             Counters& counters) {
  if (stage == as_factored && !umfpack_in_use_ && !pivots_are_fresh_) {
    stage = new_pivots;
    return factor_anew(values, usual_pivot_tolerance, counters);
  }
  if (kernel_ != Kernel::automatic || umfpack_in_use_ || stage == fallback) {
    stage = exhausted;
    return {};
  }
  stage = fallback;
  ++counters.fallbacks;
  outcome.fell_back = true;
  if (!is_compiled_in(Kernel::umfpack)) return factor_anew(values, strict_pivot_tolerance, counters);
  if (!umfpack_.is_analyzed()) {
    ++counters.symbolic;
    const FactorResult result = umfpack_.analyze(pattern_);
    if (!result.ok()) return result;
  }
  return factor_by_umfpack(values, counters);
}

CheckedSolve Factorization::solve_checked(std::span<const double> values, std::span<double> x, Counters& counters,
                                          const SolveCheck& check) {
  require_factors();
  CheckedSolve outcome;
  if (size() == 0) return outcome;
  right_hand_side_.assign(x.begin(), x.end());
  correction_.resize(x.size());
  row_scale_.resize(x.size());

  for (int stage = as_factored; stage != exhausted;) {
    outcome.residual = refine(values, x, check, outcome, counters);
    if (outcome.residual <= check.tolerance) return outcome;
    if (!std::isfinite(largest_magnitude(right_hand_side_)) || !std::isfinite(largest_magnitude(values))) {
      outcome.status = FactorStatus::not_finite;  // no kernel mends bad numbers
      return outcome;
    }
    const FactorResult result = use_safer_kernel(values, stage, outcome, counters);
    if (!result.ok()) {
      outcome.status = result.status;
      return outcome;
    }
  }
  outcome.status = FactorStatus::inaccurate;
  return outcome;
}

}  // namespace catena
