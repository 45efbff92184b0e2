#include "catena/analysis/dynamics/integrators/adams_history.hpp"

#include <cmath>

namespace catena {

bool AdamsHistory::equal_steps(std::size_t steps, double h) const {
  if (steps > count_) return false;
  for (std::size_t i = 1; i <= steps; ++i) {
    if (std::abs(back_[i] - static_cast<double>(i) * h) > 1e-6 * h) return false;
  }
  return true;
}

double AdamsHistory::sigma(std::size_t i, double h) const {
  double product = 1;
  for (std::size_t j = 1; j < i; ++j) {
    const double distance = h + (j == 1 ? 0 : back_[j - 1]);
    product *= static_cast<double>(j) * h / distance;
  }
  return product;
}

void AdamsHistory::find_weights(double s, std::size_t k, Weights& weights) const {
  Row integral{};
  for (std::size_t q = 1; q <= k + 1; ++q) integral[q] = 1 / static_cast<double>(q);
  weights.value[1] = 1;
  weights.integral[1] = integral[1];
  weights.twice[1] = integral[2];
  for (std::size_t i = 2; i <= k; ++i) {
    // The scale of a difference that was never formed is arbitrary.
    const double distance = i - 1 <= count_ ? back_[i - 1] : s;
    const double c = (s + (i == 2 ? 0 : back_[i - 2])) / distance, e = s / distance;
    for (std::size_t q = 1; q <= k + 2 - i; ++q) integral[q] = c * integral[q] - e * integral[q + 1];
    weights.value[i] = c * weights.value[i - 1];
    weights.integral[i] = integral[1];
    weights.twice[i] = integral[2];
  }
}

}  // namespace catena
