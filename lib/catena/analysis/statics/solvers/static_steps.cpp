#include "catena/analysis/statics/solvers/static_steps.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of the shifts after the least one, up to the largest stiffness.
constexpr double growth_of_shift = 1e3;

}  // namespace

void KeptPlace::keep(StaticSystem& system, std::span<const double> q_now, std::span<const double> lambda_now) {
  q.assign(q_now.begin(), q_now.end());
  lambda.assign(lambda_now.begin(), lambda_now.end());
  curves = system.evaluator().curve_places();
}

void KeptPlace::take_back(StaticSystem& system, std::span<double> q_now, std::span<double> lambda_now) const {
  std::copy(q.begin(), q.end(), q_now.begin());
  std::copy(lambda.begin(), lambda.end(), lambda_now.begin());
  system.evaluator().go_to_curve_places(curves);
  system.move_to(q_now);
}

Travel travel_of(const Plan& plan, std::span<const double> change) {
  Travel travel;
  for (int c = 0; c < plan.columns; ++c) {
    double& largest = plan.coordinate[at(c)] % 3 == 2 ? travel.turn : travel.length;
    largest = std::max(largest, std::abs(change[at(c)]));
  }
  return travel;
}

Travel travel_between(std::span<const double> from, std::span<const double> to) {
  Travel travel;
  for (std::size_t k = 0; k < from.size(); ++k) {
    double& largest = k % 3 == 2 ? travel.turn : travel.length;
    largest = std::max(largest, std::abs(to[k] - from[k]));
  }
  return travel;
}

bool factorize_convex(StaticSystem& system, std::span<const double> lambda) {
  for (double shift = 0; shift < 1; shift = shift == 0 ? least_shift : growth_of_shift * shift) {
    const double stiffness = shift > 0 ? shift * std::max(system.matrix().largest_stiffness(), 1e-300) : 0;
    system.fill(lambda, Curvature::convex, stiffness);
    if (system.factorize().ok()) return true;
  }
  return false;
}

}  // namespace catena
