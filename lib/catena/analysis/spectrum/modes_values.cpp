// ModeSearch: values and shapes of the modes from what Lanczos' method found.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/spectrum/modes_search.hpp"
#include "catena/base/at.hpp"

namespace catena {

std::vector<Mode> ModeSearch::modes_of(Lanczos& lanczos, double sigma, int count) const {
  std::vector<std::pair<double, int>> order;  // omega^2 and the number of its theta
  const std::span<const double> theta = lanczos.theta();
  for (int k = 0; k < static_cast<int>(theta.size()); ++k) order.emplace_back(sigma + 1 / theta[at(k)], k);
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), at(count)));
  std::vector<Mode> modes;
  for (const auto& [omega2, own] : order) modes.push_back({omega2, lanczos.vector(own)});
  return modes;
}

// Values come as sigma + 1 / theta, whose rounding grows with the square of the distance from sigma. The Rayleigh
// quotient of the true matrices is wrong by the square of the shape's error and by its own rounding alone. A value that
// cannot be distinguished from zero is set to zero.
void ModeSearch::refine_values(std::vector<Mode>& modes, double sigma) {
  if (modes.empty()) return;
  system_.fill(lambda_, Curvature::exact, 0);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Mode& mode : modes) nearest = std::min(nearest, std::abs(mode.omega2 - sigma));
  std::vector<double> product(mass_.size());
  for (Mode& mode : modes) {
    system_.matrix().multiply_stiffness(mode.shape, product);
    double energy = 0, inertia = 0;
    for (std::size_t c = 0; c < product.size(); ++c) {
      energy += product[c] * mode.shape[c];
      inertia += mass_[c] * mode.shape[c] * mode.shape[c];
    }
    const double terms = system_.matrix().absolute_quadratic(mode.shape), distance = std::abs(mode.omega2 - sigma);
    if (std::abs(energy) <= floor_(mode.shape)) {
      mode.omega2 = 0;
    } else if (terms * nearest < distance * distance * inertia) {
      mode.omega2 = energy / inertia;
    }
  }
}

}  // namespace catena
