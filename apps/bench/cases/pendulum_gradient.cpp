#include "cases/pendulum_gradient.hpp"

#include <algorithm>

namespace bench {

namespace {

using Complex = std::complex<long double>;
using State = std::vector<Complex>;  // angles, then rates

State slope_of(PendulumChain<Complex>& chain, const State& y) {
  const std::size_t n = chain.rods();
  State slope(2 * n);
  std::copy(y.begin() + static_cast<std::ptrdiff_t>(n), y.end(), slope.begin());
  chain.factorize(y.data());
  chain.accelerations(y.data() + n, slope.data() + n);
  return slope;
}

State moved(const State& y, const State& slope, long double h) {
  State to(y);
  for (std::size_t i = 0; i < y.size(); ++i) to[i] += h * slope[i];
  return to;
}

/// One step of the midpoint rule, extrapolated to order 16.
State step(PendulumChain<Complex>& chain, const State& y, long double length) {
  constexpr std::size_t levels = 8;
  const State start = slope_of(chain, y);
  std::vector<State> previous, current;
  for (std::size_t level = 0; level < levels; ++level) {
    const int parts = 2 * (static_cast<int>(level) + 1);
    const long double h = length / parts;
    State before = y, here = moved(y, start, h);
    for (int m = 1; m < parts; ++m) {
      State next = moved(before, slope_of(chain, here), 2 * h);
      before = std::move(here);
      here = std::move(next);
    }
    current.assign(1, std::move(here));
    for (std::size_t k = 0; k < level; ++k) {
      const long double ratio = static_cast<long double>(level + 1) / static_cast<long double>(level - k);
      State better = current[k];
      for (std::size_t i = 0; i < better.size(); ++i)
        better[i] += (current[k][i] - previous[k][i]) / (ratio * ratio - 1);
      current.push_back(std::move(better));
    }
    previous = current;
  }
  return previous.back();
}

}  // namespace

std::array<double, compared_parameters> pendulum_gradient(int rods, double duration) {
  constexpr long double beside = 1e-30L;  // its square is nothing beside one
  constexpr double steps_a_second = 75;   // as many again change the eleventh digit
  const auto n = static_cast<std::size_t>(rods);
  std::array<double, compared_parameters> gradient{};
  for (std::size_t p = 0; p < gradient.size(); ++p) {
    std::vector<Complex> numbers(2 * n, Complex(1));
    numbers[static_cast<std::size_t>(compared(rods)[p])] += Complex(0, beside);
    PendulumChain<Complex> chain({numbers.begin(), numbers.begin() + rods}, {numbers.begin() + rods, numbers.end()});
    State y(2 * n);
    for (std::size_t k = 0; k < n; ++k) y[k] = start_angle(k);
    const int steps = static_cast<int>(steps_a_second * duration);
    for (int s = 0; s < steps; ++s) y = step(chain, y, static_cast<long double>(duration) / steps);
    Complex height = 0;
    for (std::size_t k = 0; k < n; ++k)
      height += static_cast<long double>(height_weight(k, n)) * chain.length()[k] * std::sin(y[k]);
    gradient[p] = static_cast<double>(height.imag() / beside);
  }
  return gradient;
}

double gradient_error(const std::array<double, compared_parameters>& found,
                      const std::array<double, compared_parameters>& exact) {
  double worst = 0, largest = 0;
  for (std::size_t p = 0; p < found.size(); ++p) {
    worst = std::max(worst, std::abs(found[p] - exact[p]));
    largest = std::max(largest, std::abs(exact[p]));
  }
  return worst / largest;
}

}  // namespace bench
