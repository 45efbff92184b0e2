// What the steps of implicit methods, and of Rattle, have in common: how their ends are kept on the constraints and
// looked at, how changes are measured, and the polynomials between two ends.
//
//   y(t) = (1 - e) y0 + e y1 + h s (1 - s)^2 y0' - h s^2 (1 - s) y1'        s = (t - t0) / h,   e = s^2 (3 - 2 s)
//   q(t) = q0 + h (s v0 + h s^2 a0 / 2) + s^3 (d (10 - 15 s + 6 s^2) + w (-4 + 7 s - 3 s^2) + b (1 - 2 s + s^2) / 2)
//          d = q1 - q0 - h v0 - h^2 a0 / 2,   w = h (v1 - v0 - h a0),   b = h^2 (a1 - a0);   v(t) = q'(t)
//
// States as in motion.hpp.
#pragma once

#include <span>

#include "catena/analysis/dynamics/integrators/error_scale.hpp"
#include "catena/analysis/dynamics/integrators/motion.hpp"

namespace catena::implicit_step {

/// What is left of the equations of a step or of its stages, as a part of the error that it may have: it does not
/// disturb the estimate.
inline constexpr double left_part = 0.01;

/// Both ends of a step; slopes hold the accelerations that places are not interpolated by.
struct Ends {
  double from, to;
  std::span<const double> y_before, y, slope_before, slope;
};
/// The cubic of places and velocities, and that of velocities and accelerations; n: coordinates.
void interpolate(const Ends& ends, double t, std::size_t n, std::span<double> y);

/// Places and velocities as move_by_ends() has them (dense_output.hpp); what follows them by the cubic.
void interpolate_quintic(const Ends& ends, double t, std::size_t n, const ErrorScale& scale, std::span<double> y);

/// Moves the end of a step onto the constraints, with factors made there, and leaves the residual of its places, in
/// length scales or rad, in `residual`. False: it is too far from them.
bool project_end(const Motion& motion, double t, double rate, std::span<double> y, double& residual);

/// Records the end of a step of size h, where the last evaluation was.
void observe(const Motion& motion, ErrorScale& scale, double t, double h, std::span<const double> y,
             std::span<const double> slope);

/// An error that counts as one of a place and of a velocity at coordinate c: `part` of the allowed one, and what
/// rounding makes of it. The latter is zero where nothing has moved yet.
struct Units {
  double place, velocity;
};
Units units(const ErrorScale& scale, std::size_t c, double h, double speed, double part);

}  // namespace catena::implicit_step
