// How fast the mechanism moves behind a step near a singular position, by the balance of energy of the step:
//
//   T1 = T0 + V0 - V1 + W          W = h sum b_s P_s,   P: loads without a potential, less what dampers take
//   v1 += a u,   a = (T1 - T(v1)) / (v1^T M u)
//
// At a sine d from the position, rounding of places makes accelerations wrong by eps / d^3, across the constraints.
// Projection removes that at the step's end, but the direction across has turned since by about h / radius, so that
// some h of it stays along the motion: after every passage the mechanism is a little too fast or too slow. Places are
// wrong by eps / d only, velocities by eps / d^2 and across, which changes energies by its square: the balance knows
// the speed better than the integral does, by d / h or more.
//
// u: what may be wrong. With one degree of freedom the velocity itself; else the error estimate of the step, which is
// that of the same stages, without the part across the constraints. Where u says nothing about the energy (v1^T M u
// near zero), or hardly anything moves, the velocity stays as it is. A step that is wrong by much more energy than its
// errors explain has lost its way and is not made.
//
// Where drivers move all of the mechanism it is the other way round: velocities follow from the constraints, and what
// drivers do, -lambda nu, is a sharp pulse where the motion turns at a sine d from the position, of which stages see
// little, and of which rounding takes eps / d^2 of T; elsewhere it has a kink where a cable becomes taut, and no error
// of the motion shortens a step there. The balance says how much they do together:
//
//   sum dW_k = T1 - T0 + V1 - V0 + dissipated - work of loads
//
// What the integrals of their powers miss of it goes to the drivers in proportion to the error estimates of these, or,
// where there are none, to their work in the step; to an only one in any case, of whose power nothing may be seen at
// the ends of a step.
//
// Symbols: T kinetic, V potential energy in J, M masses, v velocities, h the step in s, b_s weights of its stages, dW_k
// work of a driver in the step. Source: apps/manual/numerics.md#singular-passages.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/dynamics/integrators/error_scale.hpp"
#include "catena/analysis/dynamics/integrators/motion.hpp"
#include "catena/analysis/motion/tableau.hpp"

namespace catena {

/// A step of size h (s) that ends at t; positions and velocities there are on the constraints.
struct BalancedEnds {
  double t = 0, h = 0;
  std::span<const double> y_before;
  std::span<double> y;
  std::span<const double> error{};  ///< the estimate, [q, qd, work]; empty: none
};

struct BalancedStep {
  BalancedEnds ends;
  double errors = 0;  ///< of the step and of its rounding, in units of `scale`
  const ErrorScale& scale;
  const StageSum& weights;
};

class StepEnergy {
 public:
  /// What the balance says: nothing, how fast the mechanism moves, what its drivers do.
  enum class Tells { nothing, speed, work };
  /// Of a mechanism, with all steps adaptive.
  static Tells of(const Motion& motion);

  /// `stages`: most that a step has.
  StepEnergy(const Motion& motion, std::size_t stages, double length, Tells tells);

  /// Whether steps from a place of this pivot ratio are balanced by their speed, if they are projected.
  bool watches(double ratio, bool crossing) const;
  /// Whether the balance of steps, if they are projected, says what drivers do: these move all of the mechanism.
  bool tells_work(const Motion& motion) const;
  /// Whether errors of the drivers' integrals are to bound the step: not where the balance tells what the only one does
  /// (RungeKutta::error_of_work).
  bool leaves_drivers(const Motion& motion) const;
  /// Power P at a stage, at the evaluator's place, that of y.
  void note_power(const Motion& motion, std::size_t stage, std::span<const double> y);
  /// Balances a step. False: more energy is missing than the error of the step and its rounding explain.
  bool restore(const Motion& motion, const BalancedStep& step);
  /// Gives drivers the work that the balance of a step leaves them, in step.y, where it says so.
  void restore_work(const Motion& motion, const BalancedEnds& step) const;

 private:
  int freedoms(const Motion& motion) const;
  void find_direction(const Motion& motion, const BalancedEnds& step);

  std::vector<double> power_, direction_;  // of the stages, W; u
  double weight_ = 0;                      // of all bodies, times the length scale, J
  int acting_rows_ = 0;                    // see jacobian_rank.hpp
  Tells tells_ = Tells::nothing;
};

}  // namespace catena
