#include "cases/parallelogram.hpp"

#include <cmath>
#include <initializer_list>

namespace bench {

catena::Vec2<double> Parallelogram::crank_end(double t) {
  constexpr long double w[] = {0.784513610477560L, 0.235573213359357L, -1.17767998417887L};
  constexpr long double middle = 1 - 2 * (w[0] + w[1] + w[2]);
  const int steps = static_cast<int>(std::ceil((t - t_) / 2e-4));
  const long double h = steps > 0 ? (static_cast<long double>(t) - t_) / steps : 0;
  for (int k = 0; k < steps; ++k) {
    for (const long double weight : {w[0], w[1], w[2], middle, w[2], w[1], w[0]}) {
      angle_ += weight * h / 2 * rate_;
      rate_ -= weight * h * k_ * std::cos(angle_);
      angle_ += weight * h / 2 * rate_;
    }
  }
  t_ = t;
  return {static_cast<double>(std::cos(angle_)), static_cast<double>(std::sin(angle_))};
}

}  // namespace bench
