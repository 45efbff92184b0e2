// Sums over the stages of a Runge-Kutta step, of vectors of any kind, in one pass.
//
//   out = begin + h sum_k weight_k slope_k
//
// The terms are added in the order of the tableau. Source: analysis/motion/tableau.hpp.
#pragma once

#include <array>
#include <cassert>
#include <span>

#include "catena/analysis/motion/tableau.hpp"
#include "catena/linalg/kernels/lanes.hpp"

namespace catena {

/// `slope(stage)`: where its vector begins. `begin`: empty, as zero, or of the size of `out`, which it may be. `sum`:
/// at most 17 terms.
template <class Terms, class Slope>
void add_stages(std::span<const double> begin, double h, const Terms& sum, Slope&& slope, std::span<double> out) {
  std::array<const double*, 17> k;
  std::array<double, 17> weight;
  std::size_t terms = 0;
  for (const StageTerm& term : sum) {
    assert(terms < k.size());
    k[terms] = slope(term.stage);
    weight[terms++] = h * term.weight;
  }
  const double* const from = begin.empty() ? nullptr : begin.data();
  std::size_t i = 0;
  for (; i + 2 * Lanes::count <= out.size(); i += 2 * Lanes::count) {
    Lanes x = from ? Lanes::load(from + i) : Lanes(), y = from ? Lanes::load(from + i + Lanes::count) : Lanes();
    for (std::size_t t = 0; t < terms; ++t) {
      x += weight[t] * Lanes::load(k[t] + i);
      y += weight[t] * Lanes::load(k[t] + i + Lanes::count);
    }
    x.store(out.data() + i);
    y.store(out.data() + i + Lanes::count);
  }
  for (; i < out.size(); ++i) {
    double x = from ? from[i] : 0;
    for (std::size_t t = 0; t < terms; ++t) x += weight[t] * k[t][i];
    out[i] = x;
  }
}

}  // namespace catena
