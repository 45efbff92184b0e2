// ModeSearch: values and shapes of the modes from what Lanczos' method found.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "catena/analysis/modes_search.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// v^T K v below this part of its terms cannot be told from zero.
constexpr double zero_part = 1e-14;
// How much more than rounding the error of thetas may be: solutions for a nearly singular matrix lose digits.
constexpr double theta_doubt = 1e6;

}  // namespace

// Where the basis is complete, modes far from sigma come from the matrices themselves: an error of 1e-16 in the largest
// theta, times a factor, stands against one of 1e-16 in the largest omega^2. How many are near only the latter tell:
// small thetas may be nothing but rounding.
std::vector<Mode> ModeSearch::modes_of(Lanczos& lanczos, double sigma, int count) const {
  const std::span<const double> theta = lanczos.theta();
  std::vector<int> nearest_first(theta.size());
  std::iota(nearest_first.begin(), nearest_first.end(), 0);
  std::sort(nearest_first.begin(), nearest_first.end(),
            [&](int a, int b) { return std::abs(theta[at(a)]) > std::abs(theta[at(b)]); });
  std::size_t near = theta.size();
  std::vector<std::pair<double, int>> far;  // omega^2 and the energy's number
  if (lanczos.exhausted()) {
    lanczos.resolve_upper_end();
    const std::span<const double> energy = lanczos.energy();
    const double nearest = 1 / std::abs(theta[at(nearest_first.front())]);
    const double farthest = std::max(std::abs(energy.front()), std::abs(energy.back()));
    std::vector<std::pair<double, int>> distances;
    for (std::size_t k = 0; k < energy.size(); ++k) distances.emplace_back(std::abs(energy[k]), static_cast<int>(k));
    std::sort(distances.begin(), distances.end());
    near = 1;
    while (near < distances.size() && distances[near].first * distances[near].first * theta_doubt <= nearest * farthest)
      ++near;
    for (std::size_t k = near; k < distances.size(); ++k) {
      const int own = distances[k].second;
      far.emplace_back(energy[at(own)] + sigma, own);
    }
  }
  // The lowest of both kinds; shapes of those alone.
  std::vector<std::pair<double, int>> order;  // omega^2 and the number of its theta, or -1 - that of its energy
  for (std::size_t k = 0; k < near; ++k) {
    order.emplace_back(sigma + 1 / theta[at(nearest_first[k])], nearest_first[k]);
  }
  for (const auto& [omega2, own] : far) order.emplace_back(omega2, -1 - own);
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), static_cast<std::size_t>(count)));
  std::vector<Mode> modes;
  for (const auto& [omega2, own] : order) {
    modes.push_back({omega2, own >= 0 ? lanczos.vector(own) : lanczos.energy_vector(-1 - own)});
  }
  return modes;
}

// Values come as sigma + 1 / theta, whose rounding grows with the square of the distance from sigma. The Rayleigh
// quotient of the true matrices is wrong by the square of the shape's error and by its own rounding alone. What cannot
// be told from zero is zero.
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
    if (std::abs(energy) <= zero_part * terms) {
      mode.omega2 = 0;
    } else if (terms * nearest < distance * distance * inertia) {
      mode.omega2 = energy / inertia;
    }
  }
}

}  // namespace catena
