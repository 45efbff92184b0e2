// Derivatives of the equations of static equilibrium by the parameter of a path: differences of the residual, since the
// parameter may enter a scene anywhere.
//
//   r_p = (r(p + h) - r(p - h)) / 2 h,   where r(p + h) - 2 r(p) + r(p - h) is far below r(p + h) - r(p - h)
//
// Singular: a load has a kink within the step. The derivative of the side of x is that over a shorter step; closer to
// the kink than the shortest one it is a mean of both sides.
#include <algorithm>
#include <cmath>

#include "catena/analysis/stability/path_system.hpp"

namespace catena {
namespace {

// Of a step of central differences, in parts of the parameter: near the third root of epsilon, 6e-6, rounding and the
// third derivative make errors of one size.
constexpr double difference = 1e-5;

}  // namespace

double PathSystem::parameter_step(const PathPoint& x, bool closely) const {
  return (closely ? shortest_arc : difference) * std::max(scale_, std::abs(x.p));
}

// By central differences over a step h, one-sided where the scene ends. How much the sides differ, in parts of the two.
double PathSystem::difference_over(const PathPoint& x, double h, std::vector<double>& derivative) {
  PathPoint beside = x;
  beside.p = x.p + h;
  if (!move_to(beside)) move_to(beside = x);
  residual(beside, derivative);
  const double above = beside.p - x.p;
  beside.p = x.p - h;
  if (!move_to(beside)) move_to(beside = x);
  residual(beside, side_);
  const double below = x.p - beside.p;
  move_to(x);
  residual(x, here_);
  double apart = 0, both = 0;
  for (std::size_t k = 0; k < derivative.size(); ++k) {
    if (above > 0 && below > 0 && k < weight_.size()) {
      const double forwards = (derivative[k] - here_[k]) / above, backwards = (here_[k] - side_[k]) / below;
      apart = std::max(apart, std::abs(forwards - backwards));
      both = std::max(both, std::abs(forwards) + std::abs(backwards));
    }
    derivative[k] = (derivative[k] - side_[k]) / (above + below);
  }
  return both > 0 ? apart / both : 0;
}

void PathSystem::parameter_derivative(const PathPoint& x, std::vector<double>& derivative) {
  derivative.resize(given_.size());
  double h = parameter_step(x, false);
  // Sides of a smooth load differ by some 1e-5, those of a kink by a part of themselves: half way between in size.
  const double kinked = std::sqrt(difference);
  if (difference_over(x, h, derivative) <= kinked) return;
  // A load has a kink within the step, as where a cable becomes taut, or an extreme: a shorter step tells which, down
  // to one at which rounding is as large as what the first one mixed up.
  std::vector<double> closer(derivative.size());
  for (const double last = parameter_step(x, true); h > last;) {
    h = std::max(0.1 * h, last);
    if (difference_over(x, h, closer) > kinked) continue;
    derivative.swap(closer);
    return;
  }
}

}  // namespace catena
