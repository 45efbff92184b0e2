#include "catena/analysis/motion/runaway.hpp"

#include <cmath>
#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

std::optional<double> instant_at_infinity(const Evaluator& evaluator, double t, std::span<const double> q,
                                          std::span<const double> qd, std::span<const double> qdd, double last) {
  const std::size_t moving = 3 * static_cast<std::size_t>(evaluator.plan().moving);
  std::size_t fastest = 0;
  double speed = 0;
  for (std::size_t k = 0; k < moving; k += 3) {
    if (const double v = std::hypot(qd[k], qd[k + 1]); v > speed) fastest = k, speed = v;
  }
  if (!(speed > 0)) return {};
  const auto along = [&](std::span<const double> x) {
    return (x[fastest] * qd[fastest] + x[fastest + 1] * qd[fastest + 1]) / speed;
  };
  // Backwards in time velocities point to where the body comes from.
  const double s = along(q), direction = last < t ? -1 : 1;
  if (!(direction * s > far_away * evaluator.length_scale())) return {};
  const double rho = s * along(qdd) / (speed * speed);
  // Motions of linkages are algebraic, p is a half or a third: a simple pole has 1, the tangent of two curves at
  // infinity 1/2; near a dead point, which may lie as far away, p tends to 0. Where a motion begins some two length
  // scales from the middle of what grows, rho is wrong by less than 2 / far_away: it is told from 1 by three times
  // that.
  const double sixths = std::round(6 / (rho - 1));
  if (!(rho - 1 > 3 * 2 / far_away && sixths >= 2)) return {};
  // With p velocities and accelerations tell the instant, in which the given place has no part.
  const double rest = (sixths / 6 + 1) * speed / along(qdd);
  if (!(std::abs(rest) <= std::abs(last - t))) return {};
  return t + rest;
}

void put_at_infinity(SingularPoint& point, Evaluator& evaluator, double t, std::span<const double> q,
                     std::span<const double> qd, std::span<const double> w) {
  point.kind = SingularPoint::Kind::lock_up;
  point.at_infinity = true;
  point.t = t;
  point.q.assign(q.begin(), q.end());
  const std::vector<double> motion(qd.begin(), qd.end());
  point.name_bodies(evaluator, std::span(&motion, 1));
  evaluator.set_time(t);
  std::vector<double> nu(w.size());
  evaluator.nu(nu);
  point.find_driver(evaluator, w, nu);
}

}  // namespace catena
