// The solution with the factors of BlockFactorization: for its own files only. Lanes have a file of their own, as
// beside them the compiler takes up to 2 % more instructions for numbers and for the factorization.
#pragma once

#include <stdexcept>

#include "catena/linalg/block/block_factorization.hpp"
#include "catena/linalg/block/large_block_kernels.hpp"
#include "catena/linalg/block/small_block_kernels.hpp"

namespace catena {

template <class V>
void BlockFactorization::solve_in_order(V* y) const {
  const auto panel_size = [](const Step& step) {
    return static_cast<std::size_t>(step.columns) * static_cast<std::size_t>(step.columns + step.below);
  };
  const double* panel = panels_.data();
  const int* rows = structure_.rows.data();
  for (const Step& step : steps_) {
    const bool small = detail::with_shape(step.shape, [&](auto c, auto r) {
      detail::forward<c, r>(panel, rows, y + step.first, y);
      panel += c * (c + r);
      rows += r;
    });
    if (small) continue;
    detail::solve_forward(panel, step.columns + step.below, step.columns, rows, y + step.first, y);
    panel += panel_size(step);
    rows += step.below;
  }
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    const bool small = detail::with_shape(step->shape, [&](auto c, auto r) {
      panel -= c * (c + r);
      rows -= r;
      detail::backward<c, r>(panel, rows, y + step->first, y);
    });
    if (small) continue;
    panel -= panel_size(*step);
    rows -= step->below;
    detail::solve_backward(panel, step->columns + step->below, step->columns, rows, y + step->first, y);
  }
}

template <class V>
void BlockFactorization::solve_in(std::span<V> x, std::vector<V>& work) {
  if (!factorized_) throw std::logic_error("BlockFactorization: no valid factors to solve with");
  V* const y = work.data();
  const int* const order = structure_.order.data();
  for (int k = 0; k < size(); ++k) y[k] = x[order[k]];
  solve_in_order(y);
  for (int k = 0; k < size(); ++k) x[order[k]] = y[k];
}

}  // namespace catena
