// What methods have in common that leave singular positions to Runge-Kutta: it makes the steps from where pivots of the
// constraints dip until the mechanism is behind the passage, and the method starts anew there.
//
// A dip: the smallest pivot ratio is below `singular_passage` of the largest so far and `unusual` beside those of the
// last steps (dependence.hpp). Runge-Kutta has its own copy of the state, continues with the same scale of errors
// (error_scale.hpp) and takes whole turns out of it: they must be taken only once. Times in s.
#pragma once

#include <algorithm>

#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"
#include "catena/analysis/dynamics/integrators/step_energy.hpp"

namespace catena {

class CrossingIntegrator : public Integrator {
 public:
  std::vector<std::string> remarks() const override;
  std::int64_t straight_passages() const override { return runge_kutta_.straight_passages(); }
  bool may_pause() const override { return !crossing_; }

 protected:
  CrossingIntegrator(Motion motion, const RungeKuttaOptions& options);

  /// At a start: neither crosses, nor knows the pivots of places before.
  void forget_passages();
  /// Takes note of the pivots of the last evaluation.
  void observe_ratio();
  /// Whether they are those of a singular position nearby.
  bool dips() const;
  /// A step of Runge-Kutta from time() and state(), which are its end afterwards, as is `slope` (y'); `first`: size of
  /// the first one, s. False: none can be made.
  bool step_by_runge_kutta(double limit, double first, ErrorScale& scale, std::span<double> slope);
  /// The same for a method whose next step is `h`, or always `fixed` if this is not zero: behind the passage
  /// begin_anew() is called, and h is no longer than the last step across.
  template <class BeginAnew>
  bool step_across(double limit, double fixed, double& h, ErrorScale& scale, std::span<double> slope,
                   BeginAnew&& begin_anew) {
    const double start = t_;
    if (!step_by_runge_kutta(limit, h, scale, slope)) return false;
    if (has_crossed()) {
      begin_anew();
      h = fixed > 0 ? fixed : std::min(h, t_ - start);
    }
    return true;
  }
  /// What drivers that move all of the mechanism have done since the end y_before of a step at t_before, by the balance
  /// of energy: into y at t, which is on the constraints.
  void tell_work(double t, double t_before, std::span<const double> y_before, std::span<double> y) const;
  /// Whether it says so.
  bool tells_work() const { return energy_.tells_work(motion_); }
  /// The same within the last step, for a y that is near the constraints, from the end of the step.
  void tell_work_between(double t, std::span<double> y) const;
  /// Whether errors of the work of single drivers bound the step.
  bool judges_drivers() const { return energy_.leaves_drivers(motion_); }
  /// Of the integrals of a motion, how many bound the step: those of drivers follow the others.
  std::size_t judged_works() const {
    return judges_drivers() ? motion_.works() : ErrorScale::judged(motion_.works()).size();
  }
  /// How far accelerations within a first step of length h leave the straight line from `begin` to `end`, of which
  /// methods of low order know alone: forces may be zero at both. The largest at the stages of order 8, on the way that
  /// the first one gives; infinite where there are none. The evaluator is elsewhere then.
  void find_unseen(double h, std::span<const double> begin, std::span<const double> end, std::span<double> unseen);
  /// Whether a first step needs that: at its rate, 1/s, hardly anything moves on the way to the limit, as where forces
  /// begin with rounding.
  static bool is_long_start(double rate, double remaining) { return rate * remaining <= 1; }
  /// Counts a step across, and says whether the passage lies behind it: then another method may go on.
  bool has_crossed();
  /// The memory of a scale, with step (s) and pivots.
  IntegratorMemory memory_of(const ErrorScale& scale, double step) const;

  Motion motion_;
  RungeKutta runge_kutta_;
  double usual_ratio_ = 1e-300;
  bool crossing_ = false, stepped_by_runge_kutta_ = false;

 private:
  StepEnergy energy_;
  std::vector<double> y_inside_, slope_inside_;
  double largest_ratio_ = 0;
  std::int64_t crossing_steps_ = 0;
};

}  // namespace catena
