// Sums over the stages of a Runge-Kutta step, of vectors of any kind, in one pass.
//
//   out = begin + h sum_k weight_k slope_k
//
// and, of y = [q, v] with q' = v, v' = a, what a stage of both is without the velocities of the stages before it:
//
//   v_s = v0 + h sum_k a_sk a_k        q_s = q0 + h v0 sum_j a_sj + h^2 sum_k (sum_j a_sj a_jk) a_k
//
// The terms are added in the order of the tableau. Sources: analysis/motion/tableau.hpp; E. Hairer, S. Norsett, G.
// Wanner, "Solving Ordinary Differential Equations I", section II.14.
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
inline void add_times(std::span<double> y, double weight, std::span<const double> k) {
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

/// What a stage of a second-order equation, or the end of the step, is made of.
struct StageWeights {
  double way = 0;  ///< of v0 in q, h taken out
  std::size_t terms = 0;
  std::array<int, 12> stage{};
  std::array<double, 12> of_q{}, of_v{};  ///< h^2 and h taken out
};
/// Of the stages of dormand_prince_8(), and then of the end.
const std::array<StageWeights, 13>& second_order_weights();

/// q + way v + sum of_q slope, and v + sum of_v slope.
struct SecondOrderSum {
  const double *q, *v;
  double way;
  std::size_t terms;
  std::array<const double*, 12> slope{};
  std::array<double, 12> of_q{}, of_v{};
};
/// In these rows of `width` numbers, a multiple of four.
void add_weighted_rows(const SecondOrderSum& sum, std::span<const int> rows, std::size_t width, double* q, double* v);

}  // namespace catena
