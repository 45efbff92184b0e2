// The error of a motion that is integrated, carried along with it: what each step adds, and how the mechanism makes it
// grow. There is no second run: one more evaluation of the accelerations about every radian of the motion does.
//
//   e = (dq, dv)       dq'' = da(dq, dv),   da = (a(t, q + s dq, v + s dv) - a(t, q, v)) / s
//
// by velocity Verlet's method over H, from one evaluation to the next; meanwhile the errors that the integrator
// estimates of its steps are added up, with their signs:
//
//   dq += H dv + H^2/2 da + sum,   dv += H/2 (da before + da now) + sum
//
// and then both are projected onto what the constraints allow. s: so that places move by 1e-6 length scales or rad. At
// H sigma = 1, sigma the rate of the motion or that of da, small oscillations keep their size and an error that grows
// by e per radian is given a growth of 2.6; the method is stable up to 2. Rounding of places and rates is added as at
// random. Evaluations: as many as an allowance, which takes about a millisecond, and beyond it one in fifty of the
// run's; where that is too few, in singular positions, and where velocities jump, the error is lost.
// Source: E. Hairer, S. Noersett, G. Wanner, "Solving Ordinary Differential Equations I" (1993), section II.8.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/accuracy/disturbance.hpp"
#include "catena/analysis/dynamics/integrators/step_follower.hpp"

namespace catena {

class CarriedError final : public StepFollower {
 public:
  /// Of the motion of this evaluator; it must outlive this object.
  explicit CarriedError(const Evaluator& evaluator) : motion_(evaluator) {}

  void begin(const Integrator& integrator, const EquationsOfMotion& equations) override;
  void step(const Integrator& integrator, const EquationsOfMotion& equations) override;
  void jump() override { lost_ = true; }

  bool lost() const { return lost_; }
  /// [dq, dv] at t, not far from the last step; false: it is lost.
  bool at_instant(double t, std::span<double> error) const;
  /// Largest entry: places in length scales or rad, rates in those times the rate of the motion.
  double norm(std::span<const double> error) const;
  /// Of places alone, in length scales or rad.
  double norm_of_places(std::span<const double> error) const;
  /// m, of the mechanism.
  double length() const { return motion_.length_scale(); }
  /// 1/s, of the motion.
  double rate() const { return rate_; }
  /// Takes the cost of a look at a row off the allowance, in evaluations; false: it has not enough left.
  bool spend(double cost);
  /// Whether there are equations to look at a row with, or may be.
  bool can_look() const { return affordable(cost_of_setup()); }
  /// Equations of its own, evaluated for this estimate alone, with places as rows have them.
  EquationsOfMotion& equations();

 private:
  void get_ready();
  void carry(const Integrator& integrator);
  void project(std::span<const double> q, std::span<const double> v, double size);
  void add_rounding(std::span<const double> y, double steps);
  double cost_of_setup() const;
  bool affordable(double cost) const;

  const Evaluator& motion_;
  const EquationsOfMotion* solved_ = nullptr;  // of the motion
  EvaluationWork evaluation_;
  std::optional<Evaluator> evaluator_;
  std::optional<EquationsOfMotion> equations_;
  std::size_t n_ = 0, moving_ = 0;
  bool lost_ = true, begun_ = false, drowned_ = false;   // drowned_: too large to be followed
  double t_ = 0, rate_ = 0, stiffness_ = 0, steps_ = 0;  // of the last evaluation; steps since
  double sharpest_ = 0;                                  // of the last few evaluations, 1/s
  double spent_ = 0;                                     // evaluations
  std::int64_t first_evaluation_ = 0;
  std::vector<double> error_, added_, da_, now_, y_, moduli_;
  Disturbance random_;
};

}  // namespace catena
