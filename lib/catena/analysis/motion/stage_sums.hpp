// Sums over the stages of a Runge-Kutta step, of vectors of any kind, in one pass.
//
//   out = begin + h sum_k weight_k slope_k
//
// The terms are added in the order of the tableau. Source: analysis/motion/tableau.hpp.
#pragma once

#include <array>
#include <cassert>
#include <span>
#include <vector>

#include "catena/analysis/motion/tableau.hpp"

namespace catena {

namespace detail {

/// from + sum weight vector; `from`: nullptr for zero.
struct WeightedVectors {
  const double* from = nullptr;
  std::size_t terms = 0;
  std::array<const double*, 17> vector;
  std::array<double, 17> weight;
};
void add_weighted(const WeightedVectors& sum, std::size_t size, double* out);
/// The same by the instructions that every processor has.
void add_weighted_baseline(const WeightedVectors& sum, std::size_t size, double* out);

}  // namespace detail

/// y += weight k.
inline void add_times(std::vector<double>& y, double weight, const std::vector<double>& k) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += weight * k[i];
}

namespace detail {

/// As add_stages() has them.
template <class Terms, class Slope>
WeightedVectors weighted_stages(std::span<const double> begin, double h, const Terms& of, Slope&& slope) {
  WeightedVectors sum;
  for (const StageTerm& term : of) {
    assert(sum.terms < sum.vector.size());
    sum.vector[sum.terms] = slope(term.stage);
    sum.weight[sum.terms++] = h * term.weight;
  }
  sum.from = begin.empty() ? nullptr : begin.data();
  return sum;
}

}  // namespace detail

/// `slope(stage)`: where its vector begins. `begin`: empty, as zero, or of the size of `out`, which it may be. `of`:
/// at most 17 terms.
template <class Terms, class Slope>
void add_stages(std::span<const double> begin, double h, const Terms& of, Slope&& slope, std::span<double> out) {
  detail::add_weighted(detail::weighted_stages(begin, h, of, slope), out.size(), out.data());
}

}  // namespace catena
