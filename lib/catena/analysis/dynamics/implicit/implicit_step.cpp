#include "catena/analysis/dynamics/implicit/implicit_step.hpp"

#include "catena/analysis/dynamics/integrators/dense_output.hpp"
#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"

namespace catena::implicit_step {

void interpolate(const Ends& ends, double t, std::size_t n, std::span<double> y) {
  const double h = ends.to - ends.from, s = (t - ends.from) / h;
  const double end = s * s * (3 - 2 * s), slope0 = h * s * (1 - s) * (1 - s), slope1 = -h * s * s * (1 - s);
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double k0 = k < n ? ends.y_before[n + k] : ends.slope_before[k], k1 = k < n ? ends.y[n + k] : ends.slope[k];
    y[k] = (1 - end) * ends.y_before[k] + end * ends.y[k] + slope0 * k0 + slope1 * k1;
  }
}

void interpolate_quintic(const Ends& ends, double t, std::size_t n, const ErrorScale& scale, std::span<double> y) {
  const double h = ends.to - ends.from;
  move_by_ends({h, ends.y_before, ends.y, ends.slope_before, ends.slope}, n, (t - ends.from) / h, scale, y);
  const auto rest = [n](std::span<const double> all) { return all.subspan(2 * n); };
  interpolate({ends.from, ends.to, rest(ends.y_before), rest(ends.y), rest(ends.slope_before), rest(ends.slope)}, t, 0,
              y.subspan(2 * n));
}

bool project_end(const Motion& motion, double t, double rate, std::span<double> y, double& residual) {
  EquationsOfMotion& equations = motion.equations();
  if (equations.plan().rows == 0) return true;
  if (!equations.factorize(t, Side::before, motion.q(y))) return false;
  residual = equations.project_position(motion.q(y), 4);
  if (!(residual < RungeKutta::largest_residual)) return false;
  equations.project_velocity(motion.qd(y), rate);
  return true;
}

void observe(const Motion& motion, ErrorScale& scale, double t, double h, std::span<const double> y,
             std::span<const double> slope) {
  const EquationsOfMotion& equations = motion.equations();
  scale.observe(t, h, motion.q(y).first(motion.moving()), motion.qd(y).first(motion.moving()),
                motion.qd(slope).first(motion.moving()), equations.applied_forces(), equations.smallest_pivot_ratio());
}

Units units(const ErrorScale& scale, std::size_t c, double h, double speed, double part) {
  const auto unit = [part](double of_tolerance, double of_both) { return of_both - (1 - part) * of_tolerance; };
  return {unit(scale.position_unit(c, 0), scale.position_unit(c, h)),
          unit(scale.velocity_unit(c, 0, speed), scale.velocity_unit(c, h, speed))};
}

}  // namespace catena::implicit_step
