// Corners of a path of equilibria: where a stiffness jumps, because an elastic cable becomes slack or taut, a compliant
// stop is met, or the curve of a spring has a kink. The equilibrium goes on there with another tangent.
//
// Passed by less than a right angle the corrector finds the points behind the corner on the plane across the tangent;
// halving the step keeps the turn of the direction where there is a corner, and diminishes it where the path bends.
// Turned back, no point lies ahead: the tangent behind is that of the matrix ahead of the corner, off the path. Both
// matrices agree across the surface on which the stiffness jumps, so that along the path the sign of
//
//   det [ A  b ; t^T ] = det A (t_p + ...),     A: matrix of equilibrium, b: derivative by the parameter, t: tangent
//
// stays: t_p changes its sign if the number of negative modes changes by an odd one. Source: E. Allgower, K. Georg,
// Introduction to Numerical Continuation Methods, 2003, chapter 12. Singular: several corners within 1e-6 of each
// other count as one; a corner that another path crosses is passed along one of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/stability/path_march.hpp"
#include "catena/base/at.hpp"

namespace catena {
double Path::March::angle(const PathPoint& a, const PathPoint& b) const {
  return std::acos(std::clamp(system_.product(a, b), -1.0, 1.0));
}

bool Path::March::solve_at(double s, Side& side) {
  side = {s, system_.advanced(x_, direction_, s), {}};
  if (system_.correct(side.point, x_, direction_, s) < 0 || !system_.factorize(side.point)) return false;
  side.direction = system_.tangent(side.point, direction_);
  return true;
}

bool Path::March::find_corner(double s, Side& behind) {
  Side before{0, x_, direction_}, middle;
  if (!solve_at(s, behind)) return false;
  const double turn = angle(before.direction, behind.direction);
  while (behind.s - before.s > shortest_arc) {
    if (!solve_at(0.5 * (before.s + behind.s), middle)) return false;
    const double first = angle(before.direction, middle.direction), second = angle(middle.direction, behind.direction);
    // An even bend leaves half of the turn at each step, and here nothing in the end.
    if (2 * std::max(first, second) < turn) return false;
    (first > second ? behind : before) = middle;
  }
  // The tangent is taken where differences by the parameter do not reach back over the corner.
  if (!solve_at(behind.s + beside_point, middle)) return false;
  behind.direction = middle.direction;
  PathPoint travel{std::vector<double>(at(path_.plan_->columns)), {}, behind.point.p - before.point.p};
  for (int c = 0; c < path_.plan_->columns; ++c) {
    const std::size_t k = at(path_.plan_->coordinate[at(c)]);
    travel.q[at(c)] = behind.point.q[k] - before.point.q[k];
  }
  // The way from one side to the other along its own direction, with a factor of two for rounding: another path beside
  // the end of this one is further away.
  const double along = system_.product(behind.direction, direction_);
  return std::sqrt(system_.product(travel, travel)) * along <= 2 * (behind.s - before.s);
}

bool Path::March::find_turn(Side& behind) {
  const PathPoint ahead = system_.advanced(x_, direction_, beside_point);
  if (!system_.factorize(ahead)) return false;
  const std::optional<PathStability> found = system_.stability();
  if (!found) return false;
  PathPoint side = system_.tangent(ahead, direction_);
  const bool turns = (found->negative - modes_.negative) % 2 != 0;
  if ((side.p * direction_.p < 0) != turns) {
    for (double& v : side.q) v = -v;
    for (double& v : side.lambda) v = -v;
    side.p = -side.p;
  }
  if (system_.product(side, direction_) >= largest_bend) return false;
  behind.s = beside_point;
  behind.point = system_.advanced(x_, side, beside_point);
  if (system_.correct(behind.point, x_, side, beside_point) < 0 || !system_.factorize(behind.point)) return false;
  behind.direction = system_.tangent(behind.point, side);
  return system_.product(behind.direction, side) >= largest_bend;
}

bool Path::March::go_round(Side behind, bool& written) {
  if (passes_end(x_.p, behind.point.p)) return false;
  if (path_.system_.has_gaps()) {
    double s = behind.s;
    bool located = true;
    PathPoint point = behind.point;
    if (change_within(point, s, located) || !located) {
      changing_.clear();
      return false;
    }
  }
  if (!system_.factorize(behind.point)) return false;
  const std::optional<PathStability> modes = stability_of(behind.point);
  if (!modes) return false;
  if (*modes != modes_) {
    report_->warnings.push_back(
        fmt::format("at the value {:.10g} of the parameter a stiffness jumps, and motions that are unstable change "
                    "there from {} to {}",
                    behind.point.p, modes_.negative + modes_.pairs, modes->negative + modes->pairs));
  }
  x_ = std::move(behind.point);
  direction_ = std::move(behind.direction);
  modes_ = *modes;
  changed_here_ = 0;
  written = write(x_);
  return true;
}

}  // namespace catena
