// Adaptive explicit Runge-Kutta integration of a constrained motion: orders 8 and 5 (tableau.hpp), kept on the
// constraints in one of three ways.
//
// Projection: positions and velocities, after every step, in the mass metric.
// Stabilisation (J. Baumgarte, Comp. Meth. Appl. Mech. Eng. 1 (1972)): nothing is projected; the accelerations meet
//   Phi'' + 2 s Phi' + s^2 Phi = 0        s = rate of the motion, see error_scale.hpp, at most 1 / fixed step
// in place of Phi'' = 0, so that what errors of integration leave of Phi decays while the mechanism moves on. s changes
// between steps when it is wrong by a factor of two. (As large as 1 / step it would destroy the order: stages miss the
// constraints by h^2, which s^2 makes an error of order one.) The drift is of the size of the tolerance, or of the
// error of a fixed step. Steps across singular positions are projected: stabilised, they would end on any branch.
//
// Partition: independent coordinates are integrated, the others solved for at every stage (coordinate_partition.hpp).
//   Across singular positions, where no choice of independent coordinates holds, steps are projected as well.
//
// Passing singular positions (flat four-bars) without knowing of them takes five things, all found by experiment
// (apps/manual/numerics.md#singular-passages): the part of an error estimate that the projection removes does not
// count; a step across such a position is made with all its stages projected; none ends where a pivot of the Schur
// complement keeps less than 1e-7 of itself, or than a limit that follows from the tolerance; where order 8 fails
// repeatedly, order 5 takes over for a while; and the speed behind a step near such a position is the one that its
// balance of energy gives (step_energy.hpp). One object an integration; nothing allocates after construction.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/branches/branch_keeping.hpp"
#include "catena/analysis/dynamics/integrators/branch_turn.hpp"
#include "catena/analysis/dynamics/integrators/coordinate_partition.hpp"
#include "catena/analysis/dynamics/integrators/crossing_trials.hpp"
#include "catena/analysis/dynamics/integrators/dense_output.hpp"
#include "catena/analysis/dynamics/integrators/error_scale.hpp"
#include "catena/analysis/dynamics/integrators/integrator.hpp"
#include "catena/analysis/dynamics/integrators/motion.hpp"
#include "catena/analysis/dynamics/integrators/stage_ratios.hpp"
#include "catena/analysis/dynamics/integrators/stages.hpp"
#include "catena/analysis/dynamics/integrators/step_energy.hpp"
#include "catena/analysis/dynamics/integrators/step_order.hpp"
#include "catena/analysis/motion/stage_watcher.hpp"

namespace catena {

enum class ConstraintKeeping { projection, stabilisation, partition };

struct RungeKuttaOptions {
  int order = 8;  ///< 5 or 8
  ConstraintKeeping keeping = ConstraintKeeping::projection;
  double tolerance = 1e-10;  ///< of a step's error, see error_scale.hpp
  double fixed_step = 0;     ///< s; 0: adaptive
  double horizon = 0;        ///< s, where the run ends: the tolerance of a step depends on how far that is
  bool may_lower_order = true;
  /// Smallest pivot ratio in usual places where the start is none (RedundantRows::generic_ratio).
  double usual_ratio = 0;
};

class RungeKutta final : public Integrator {
 public:
  /// Of positions after their projection, in length scales or rad: more has left the constraints.
  static constexpr double largest_residual = 1e-6;

  RungeKutta(Motion motion, const RungeKuttaOptions& options);

  bool start(double t, std::span<const double> y) override;
  bool advance(double limit) override;
  /// Of order 7 or 5.
  void interpolate(double t, std::span<double> y) override;
  std::vector<std::string> remarks() const override;
  std::int64_t straight_passages() const override { return turn_.straight_on().times; }
  /// What is said of passages where two branches are near to each other.
  void remark_on_branches(std::vector<std::string>& remarks) const;
  IntegratorMemory memory() const override;
  void remember(const IntegratorMemory& memory) override;
  bool may_pause() const override { return !crossing_ && !trials_.is_ending_near(); }
  /// Continues with steps of size h (s) from the state (t, y) of another method, with its scale of errors and its
  /// largest pivot ratio.
  bool take_over(double t, std::span<const double> y, double h, const ErrorScale& scale, double usual_ratio);
  void add_error(std::span<double> error) const override;
  std::span<const double> accelerations() const override {
    return std::span(slope_).subspan(motion_.coordinates(), motion_.coordinates());
  }
  double rate() const override { return scale_.rate(); }
  std::span<const double> slope() const { return slope_; }
  const ErrorScale& scale() const { return scale_; }
  /// Smallest pivot ratio at the last evaluation, compared with the largest so far: very unequal masses make all small.
  double pivot_ratio() const;
  /// Whether the stages of the last step indicate a singular position within it.
  bool dips() const;

  bool meets_constraints() const override { return options_.keeping != ConstraintKeeping::stabilisation; }

  /// Shows the stages of order 8 from now on, of steps that are projected at their ends alone; nullptr: to nobody.
  void show_stages_to(StageWatcher* watcher) override { watcher_ = watcher; }

 private:
  enum class Trial { made, again, failed };
  /// Of a step that is tried; whether it ends at the limit.
  struct Length {
    double h = 0;
    bool lands = false;
  };
  /// What the error of a step says; whether the equations were factored at its end meanwhile.
  struct Judgement {
    double error = 0, rounding = 0, growth = 1;
    bool accurate = false, factored = false;
  };
  const Tableau& tableau() const { return order_.tableau(); }
  bool is_fixed() const { return options_.fixed_step > 0; }
  bool projects() const { return crossing_ || options_.keeping == ConstraintKeeping::projection; }
  bool derivative(double t, Side side, std::span<const double> y, std::span<double> k) const {
    return motion_.derivative(t, side, y, k, stabilisation_);
  }
  bool partitions() const { return partition_ && !crossing_; }
  bool follow_motion();
  bool begin_projection();
  bool begin_showing();
  bool evaluate_stages(double h);
  bool project_stage(double t, Side side);
  bool solve_dependent(double t, Side side, std::span<double> y) {
    return partition_->solve(t, side, motion_.q(y), motion_.qd(y));
  }
  bool factorize_new_point();
  double error_size(double h);
  double error_of_work(double h) const;
  double filtered_error(double h, double raw);
  double compared_with_end(double h, double error);
  double rounding_of_velocity(double h) const;
  double rounding_of_crossing(double h) const;
  bool finish_step();
  bool watches_energy() const;
  bool tells_work() const;
  BalancedEnds balanced_ends(double t, double h, std::span<const double> before, std::span<double> y) const;
  bool balance(double h);
  bool begin_step();
  Length next_length(double limit) const;
  Trial try_step(double limit, double& usual);
  Judgement judge(double h);
  Trial cut_short(double h);
  bool try_crossing(double h, const Judgement& judged);
  bool passes_beside() const;
  bool leaves_branch(double h);
  void reject(double h);
  void accept(double growth, double proposed);
  void observe_ratio();
  void observe_rates();
  StepRatios ratios() const { return {ratios_.at_start(), ratios_.smallest(), pivot_ratio()}; }
  bool prepare_interpolant();
  bool integrate_to(double t, std::span<double> y);
  bool finish_cut();
  void get_interpolant_ready();
  void balance_between(double t, std::span<double> y);
  void evaluate_interpolant(double t, std::span<double> y);
  StepEnds ends() const { return {t_ - t_before_, y_before_, y_, stage_[0], slope_}; }
  void work_by_ends(double s, std::span<double> y);

  Motion motion_;
  StageWatcher* watcher_ = nullptr;
  std::unique_ptr<CoordinatePartition> partition_;  // only where it is asked for
  std::unique_ptr<BranchKeeping> branches_;         // only where steps can be judged
  RungeKuttaOptions options_;
  ErrorScale scale_;
  double t_new_ = 0, h_ = 0, stabilisation_ = 0;
  std::vector<double> y_before_, y_new_, y_stage_, slope_, slope_new_;
  Stages stage_;
  DenseOutput dense_;
  struct {
    std::vector<double> high, low;  // [q, qd, work], [q, qd]
    double of_step = 1;             // that is accepted, in tolerances, at least 1
  } error_;
  StepOrder order_;
  StageRatios ratios_;
  CrossingTrials trials_;
  BranchTurn turn_;
  StepEnergy energy_;
  bool crossing_ = false;   // steps are projected that are not elsewhere
  bool work_told_ = false;  // work of drivers in the last step is that of its balance
  std::int64_t projected_steps_ = 0;
  StepSwitches::Found switches_;  // in the step that is tried
};

}  // namespace catena
