// Adaptive explicit Runge-Kutta integration of a constrained motion: orders 8 and 5 (tableau.hpp), both projected onto
// the constraints after every step, positions and velocities, in the mass metric.
//
// Passing singular positions (flat four-bars) without knowing of them takes four things, all found by experiment (see
// NUMERICS.md): the part of an error estimate that the projection removes does not count; a step across such a position
// is made with all its stages projected; none ends where a pivot of the Schur complement keeps less than 1e-7 of
// itself, or what the tolerance makes of it; where order 8 does not get ahead, order 5 takes over for a while. One
// object an integration; nothing allocates after construction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catena/analysis/integrators/error_scale.hpp"
#include "catena/analysis/integrators/motion.hpp"
#include "catena/analysis/integrators/tableau.hpp"

namespace catena {

struct RungeKuttaOptions {
  int order = 8;             ///< 5 or 8
  double tolerance = 1e-10;  ///< of a step's error, see error_scale.hpp
  double fixed_step = 0;     ///< s; 0: adaptive
  double horizon = 0;        ///< s, where the run ends: the tolerance of a step depends on how far that is
  bool may_lower_order = true;
};

class RungeKutta {
 public:
  RungeKutta(Motion motion, const RungeKuttaOptions& options);

  /// Starts, or starts anew after a jump, at (t, y), which must meet the constraints. False: no acceleration there.
  bool start(double t, std::span<const double> y);
  /// Makes one step that does not go beyond `limit` (> time()). False: none can be made; see culprit().
  bool advance(double limit);

  double time() const { return t_; }
  std::span<const double> state() const { return y_; }
  std::span<const double> derivative() const { return slope_; }
  double previous_time() const { return t_before_; }
  /// The state at t between previous_time() and time(), order 7 or 5; constraints are met to that order only.
  void interpolate(double t, std::span<double> y);

  double step() const { return h_; }
  std::int64_t low_order_steps() const { return low_order_steps_; }
  /// Coordinate (of a moving body) whose error was largest in the step that failed; -1: not finite, or constraints.
  int culprit() const { return culprit_; }
  double position_residual() const { return position_residual_; }

 private:
  const Tableau& tableau() const {
    return options_.order == 5 || low_order_left_ > 0 ? dormand_prince_5() : dormand_prince_8();
  }
  /// out = from + h sum weight stage; `from` may be nullptr.
  void combine(const StageSum& sum, double h, const double* from, std::span<double> out) const;
  bool evaluate_stages(double h);
  bool project_stage(double t, Side side);
  bool factorize_new_point();
  double error_size(double h);
  double filtered_error(double h, double raw);
  bool finish_step();
  bool detour(double h);
  void repeat_with_projected_stages(double h);
  bool try_crossing(double h, double error);
  void reject(double h);
  void accept(double growth, double proposed);
  /// Smallest pivot ratio at the last evaluation, compared with the largest so far: very unequal masses make all small.
  double pivot_ratio() const;
  /// Whether a singular position lies within the step whose stages were evaluated, as far as they show it.
  bool dips() const;
  void observe_ratio();
  void observe_rates();
  void prepare_interpolant();

  Motion motion_;
  RungeKuttaOptions options_;
  ErrorScale scale_;
  double t_ = 0, t_before_ = 0, t_new_ = 0, h_ = 0;
  std::vector<double> y_, y_before_, y_new_, y_stage_, slope_, slope_new_;
  std::vector<std::vector<double>> stage_;
  std::vector<std::vector<double>> interpolant_;
  std::vector<double> error_, error_low_;  // [q, qd]
  bool interpolant_ready_ = false, step_was_low_order_ = false, passing_singular_ = false, projecting_stages_ = false;
  int low_order_left_ = 0, rejections_ = 0, detours_ = 0, culprit_ = -1;
  std::int64_t low_order_steps_ = 0;
  double accepted_error_ = 1, best_error_ = 0, best_step_ = 0;
  double position_residual_ = 0, smallest_stage_ratio_ = 1, largest_stage_ratio_ = 1, start_ratio_ = 1,
         undisturbed_step_ = 0, singular_ratio_ = 0, usual_ratio_ = 1e-300;
};

}  // namespace catena
