// Kinematic analysis: positions, velocities and accelerations of a driven mechanism over time (THEORY section 3).
//
// Between rows the motion is followed in steps of its own choice: a step whose prediction was far off, or on which
// Newton contracted badly, is halved, so that no branch is jumped however coarse the rows are; where no step can be
// made any more the mechanism is at a singular configuration, and the report says when and where. Velocities,
// accelerations and multipliers are computed at rows only and only if needed. Zero allocations a step after the first.
#pragma once

#include <memory>
#include <optional>

#include "catena/analysis/analysis_report.hpp"
#include "catena/analysis/assemble.hpp"
#include "catena/analysis/driven_solver.hpp"
#include "catena/analysis/predictor.hpp"
#include "catena/analysis/row_observer.hpp"
#include "catena/analysis/system_state.hpp"
#include "catena/analysis/time_grid.hpp"

namespace catena {

struct KinematicsOptions {
  double tolerance = 1e-12;       ///< of constraint residuals, relative to the length scale
  bool inverse_dynamics = false;  ///< multipliers from Phi_q^T lambda = Q - M qdd
};

class Kinematics {
 public:
  explicit Kinematics(std::shared_ptr<const Model> model, const PlanOptions& plan_options = {},
                      const KinematicsOptions& options = {});

  const Plan& plan() const { return *plan_; }
  Evaluator& evaluator() { return evaluator_; }

  /// Starts from a state of an earlier analysis instead of the given configuration at t = 0.
  void start_from(const SystemState& state);
  /// Assembles at the present time.
  AssemblyOutcome assemble();
  /// Assembles at the first instant, if nothing did before, and goes through the grid.
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);
  /// Position at t, following the motion from where it is now; then the rest as needed.
  Report move_to(double t);
  Report solve_rates(const Needs& needs);

  double time() const { return t_; }
  std::span<const double> q() const { return q_; }
  std::span<const double> qd() const { return qd_; }
  std::span<const double> qdd() const { return qdd_; }
  std::span<const double> lambda() const { return lambda_; }
  /// The present state, absolute and in model order; velocities if they are known.
  SystemState state() const;
  const DrivenSolver& solver() const { return solver_; }

 private:
  bool assemble_nearby();
  Report prepare();
  enum class StepOutcome { made, too_long, crossed };
  StepOutcome try_step(double t);
  Report cancelled() const;
  void remember_signs();
  bool find_velocity();
  double largest_rate() const;
  void set_anchor();
  bool pass_singular(double before, double after, double target);
  Report stuck(double t);
  Report check_redundant_rows();
  void scatter_applied_forces();

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  Evaluator evaluator_;
  KinematicsOptions options_;
  DrivenSolver solver_;
  Predictor predictor_;
  std::optional<AssemblyOutcome> assembled_;
  bool prepared_ = false, has_velocity_ = false, has_acceleration_ = false;
  RowObserver* observer_ = nullptr;  // during run(): asked between rows too whether to go on
  double t_ = 0;
  std::vector<double> q_, qd_, qdd_, lambda_, trial_, loads_, applied_;
  std::vector<signed char> signs_;  // of the block determinants at q_
  std::vector<std::string> redundant_;

  // Where the motion was when it first met a singular configuration: to extrapolate across it.
  double anchor_t_ = 0;
  std::vector<double> anchor_q_, anchor_qd_, anchor_qdd_;
  NewtonOutcome newton_;
};

}  // namespace catena
