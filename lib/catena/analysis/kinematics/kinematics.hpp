// Kinematic analysis: positions, velocities and accelerations of a driven mechanism over time
// (apps/manual/kinematics.md).
//
// Between rows the motion is followed in steps of adapted length: a step whose prediction was far off, or on which
// Newton's method contracted badly, is halved, so that no branch is jumped however coarse the rows are. Where branches
// meet, the instant is located, the branches are listed, and the motion continues along its own branch or along the one
// chosen. Where no step can be made any more the mechanism is locked: the report gives the instant and the cause, and a
// last row gives the place, without the rates, which grow without bound there. Velocities, accelerations and
// multipliers are computed only at rows and only if needed, or to check redundant equations; where work is needed also
// between rows. Multipliers at a singular configuration are the limit of those on both sides, null where there is none.
// Zero allocations a step after the first.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "catena/analysis/kinematics/driven_solver.hpp"
#include "catena/analysis/kinematics/kinematics_bridge.hpp"
#include "catena/analysis/kinematics/predictor.hpp"
#include "catena/analysis/motion/energy_account.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/pose/branches.hpp"
#include "catena/analysis/pose/minimum_norm.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/run/analysis_report.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/run/time_grid.hpp"
#include "catena/analysis/run/watched_elements.hpp"

namespace catena {

struct KinematicsOptions {
  double tolerance = 1e-12;       ///< of constraint residuals, relative to the length scale
  bool inverse_dynamics = false;  ///< multipliers from Phi_q^T lambda = Q - M qdd
  /// Which of the branches listed is taken wherever several meet. 0: not chosen: the motion continues along its own
  /// branch, which is branch 1; where it starts at such a place it ends with the list.
  int branch = 0;
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
  /// Position at t, following the motion from where it is now; then the rest as needed. Where nothing was assembled yet
  /// that is done first; `under_driven` where constraints and drivers do not determine the motion.
  Report move_to(double t);
  Report solve_rates(const Needs& needs);
  /// From the present instant on, move_to() sums up the work that is done on the way, and snapshot() has it.
  Report sum_up_work();
  /// The mechanism as it is now, with what was solved for there, multipliers apart. Valid until it moves.
  Snapshot snapshot() const;

  double time() const { return t_; }
  std::span<const double> q() const { return q_; }
  std::span<const double> qd() const { return qd_; }
  std::span<const double> qdd() const { return qdd_; }
  std::span<const double> lambda() const { return lambda_; }
  /// The present state, absolute and in model order; velocities if they are known.
  SystemState state() const;
  /// Where a body is now: the frame in which its points and attachments were given. By its number in the model; throws
  /// std::out_of_range for one that no body has.
  Frame<double> frame(int body) const { return frame_of(evaluator_, q_, body); }
  const DrivenSolver& solver() const { return solver_; }
  /// To look at the neighbourhood of a row once the run is over.
  DrivenSolver& solver() { return solver_; }
  /// Whether some row of the last run lies where the motion is interpolated across a singular position.
  bool interpolated() const { return interpolated_; }
  /// The singular configurations met so far, in the order in which they were met.
  const std::vector<SingularPoint>& singular_points() const { return singular_points_; }

 private:
  bool assemble_nearby();
  Report get_ready(double direction);
  Report prepare(double direction);
  Report lock_up(SingularPoint point);
  std::optional<SingularPoint> dead_point_here();
  Report follow_to(double t);
  Report find_rates(const Needs& needs);
  Report start_singular(SingularPoint point, double direction);
  bool choose_rows(std::span<const double> q);
  bool choose_better_rows();
  enum class StepOutcome { made, dipped, too_long, crossed, left_curve };
  StepOutcome try_step(double t, bool ignore_dips);
  struct Pace;
  Report go_along_bridge(double t, Pace& pace);
  Report take_step(double next, double target, Pace& pace);
  Report shorten_step(StepOutcome outcome, double next, double target, Pace& pace, Report& passed);
  bool leaves_curve(double t);
  bool heads_for_singularity(double t) const;
  void remember_margins();
  Report cancelled() const;
  bool predict(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const;
  void restore_fixed(std::span<double> q, std::span<double> qd, std::span<double> qdd) const;
  bool find_velocity();
  double largest_rate() const;
  Report stuck(double next, double target);
  bool locate_lock_up(double target, SingularPoint& point);
  void give_row_at_lock_up(const Needs& needs, RowObserver& observer);
  Report check_redundant_rows();
  Report check_redundant_rates(double allowed, bool in_words);
  Report contradicts(int row, const std::string& how);
  void scatter_applied_forces(std::span<const double> qd, std::span<const double> qdd);
  Report solve_multipliers();
  void choose_least_reactions();
  bool multipliers_on_bridge(double t, std::span<double> lambda);
  void find_limit_of_multipliers();
  // Work along the motion: kinematics_work.cpp.
  Report start_work();
  double energy_gap() const;
  double energy_scale() const;
  double stretch(double limit) const;
  Report sum_up_stretch(double t, double& error, std::vector<std::string>& warnings);
  Report move_and_sum_up(double t);
  std::string doubt_of_work() const;
  void remark_on_limits(std::vector<std::string>& warnings) const;

  // Singular configurations: kinematics_passage.cpp, kinematics_instants.cpp, kinematics_entry.cpp.
  enum class Passage { none, regular, passed, failed };
  bool add_node(MotionBridge& bridge, double t, double allowed);
  bool build_bridge(MotionBridge& bridge, double centre, double h, double reach);
  bool follows_constraints(const MotionBridge& bridge, double from, double to);
  bool margins_on(const MotionBridge& bridge, double t, std::vector<BlockMargin>& margins);
  std::vector<double> singular_instants(const MotionBridge& bridge, double from, double to);
  double refine_instant(const MotionBridge& bridge, std::size_t block, double a, double b);
  bool find_rest(const MotionBridge& bridge, double& t, double from, double to);
  SingularPoint look_at(const MotionBridge& bridge, double t, double from, double to);
  double bridge_length(double centre, double reach);
  Passage pass_singular(double next, double target, double reach, Report& report);
  Passage follow_bridge(const MotionBridge& bridge, double t);
  Report take_branch(const SingularPoint& point, int branch, double direction);
  void leave_bridge(double end);
  void place_on_bridge(double t);
  bool functions_go_on(double t) const;
  void announce(const SingularPoint& point, Report& report);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  Evaluator evaluator_;
  KinematicsOptions options_;
  DrivenSolver solver_;
  WatchedElements watched_;
  std::vector<double> places_[3], halfway_;  // on curves that end: where a step begins, halfway, where it ends
  std::vector<CurvePlace> curve_places_;     // at q_; empty: not looked at yet, or there are none
  Predictor predictor_;
  std::optional<AssemblyOutcome> assembled_;
  bool prepared_ = false, placed_ = false;  // the constraints drive it; the solver is where q_ is
  bool has_velocity_ = false, has_acceleration_ = false;
  RowObserver* observer_ = nullptr;                             // in run(): decides between rows whether to go on
  double earliest_ = -std::numeric_limits<double>::infinity();  // rows of run(): instants outside are not reported
  double latest_ = std::numeric_limits<double>::infinity();
  double t_ = 0;
  std::vector<double> q_, qd_, qdd_, lambda_, least_lambda_, trial_, loads_, applied_, nothing_;
  std::vector<double> rest_, rates_;  // of redundant rows, by row; of a check, by column
  // The signed distance of the blocks of Phi_q from singular ones at q_; the rate of change of their determinants'
  // magnitudes; and the largest value of each pivot so far.
  std::vector<BlockMargin> margins_;
  std::vector<double> margin_rates_, largest_margins_;
  double margins_t_ = 0;
  std::vector<double> predicted_qd_, predicted_qdd_;  // rates at `predicted_`, of the sizes that are needed
  std::optional<double> predicted_;
  std::vector<int> fixed_;  // coordinates that are no unknowns: of immobile bodies, angles of particles
  std::vector<std::string> redundant_;
  std::optional<MinimumNorm> minimum_norm_;  // of multipliers, where rows depend on each other
  std::string ambiguity_;                    // in words: the elements whose reactions are not unique
  // Rows at singular configurations whose multipliers are limits: how many, the first instant, and the elements without
  // a limit, in words.
  std::int64_t limit_rows_ = 0;
  double limit_t_ = 0;
  std::string without_limit_;
  std::optional<EnergyAccount> account_;  // while work is summed up
  std::vector<double> work_, power_, cubic_part_, driver_work_;
  double initial_energy_ = 0, exchanged_ = 0, unsure_ = 0, stretch_part_ = 1;
  double chosen_rcond_ = 0;  // of the rows in use, where they were chosen
  NewtonOutcome newton_;

  // The stretch of time where rows are taken from the bridge, and the branch point in it that is still ahead.
  MotionBridge bridge_;
  double bridge_from_ = 0, bridge_to_ = 0;
  bool on_bridge_ = false;
  bool interpolated_ = false;
  std::optional<SingularPoint> choice_;
  std::vector<SingularPoint> singular_points_;
};

}  // namespace catena
