// The state within a step of Runge-Kutta, at t0 + s h, from its ends and its stages.
//
// Order 8: the interpolant of order 7 of DOP853, from three more stages,
//   y0 + s (r1 + (1-s) (r2 + s (r3 + (1-s) (r4 + s (r5 + (1-s) (r6 + s r7))))))
// Order 5, or stages that cannot be evaluated: positions by the quintic through positions, velocities and accelerations
// at both ends, velocities by its derivative; what is integrated along has the caller's rule.
// Source: tableau.hpp.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/dynamics/integrators/error_scale.hpp"
#include "catena/analysis/dynamics/integrators/stages.hpp"

namespace catena {

/// A step of size h (s) from y0 to y1; slopes at both.
struct StepEnds {
  double h = 0;
  std::span<const double> y0, y1, slope0, slope1;
};

/// Positions and velocities, n of each, at s (0 ... 1) by the ends; `scale` knows the rounding of positions.
void move_by_ends(const StepEnds& ends, std::size_t n, double s, const ErrorScale& scale, std::span<double> y);

class DenseOutput {
 public:
  explicit DenseOutput(std::size_t size) : r_(7, std::vector<double>(size, 0.0)) {}

  void forget() { ready_ = false; }
  void use_ends(bool by_ends) { by_ends_ = by_ends; }
  bool by_ends() const { return by_ends_; }
  bool needs_stages() const { return !by_ends_ && !ready_; }
  /// By the interpolant of order 7; `stages` have those that it needs.
  void set(const StepEnds& ends, const Stages& stages);
  void evaluate(std::span<const double> y0, double s, std::span<double> y) const;

 private:
  std::vector<std::vector<double>> r_;
  bool ready_ = false, by_ends_ = false;
};

}  // namespace catena
