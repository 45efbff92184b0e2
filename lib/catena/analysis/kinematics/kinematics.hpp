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

#include "catena/analysis/kinematics/course/bridged_stretch.hpp"
#include "catena/analysis/kinematics/course/contact_jumps.hpp"
#include "catena/analysis/kinematics/course/margin_history.hpp"
#include "catena/analysis/kinematics/course/predictor.hpp"
#include "catena/analysis/kinematics/driven_reactions.hpp"
#include "catena/analysis/kinematics/driven_solver.hpp"
#include "catena/analysis/kinematics/row_choice.hpp"
#include "catena/analysis/kinematics/work_sum.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/pose/branches.hpp"
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

  const Plan& plan() const { return evaluator_.plan(); }
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

  double time() const { return now_.t; }
  std::span<const double> q() const { return now_.q; }
  std::span<const double> qd() const { return now_.qd; }
  std::span<const double> qdd() const { return now_.qdd; }
  std::span<const double> lambda() const { return reactions_.multipliers(); }
  /// The present state, absolute and in model order; velocities if they are known.
  SystemState state() const;
  /// Where a body is now: the frame in which its points and attachments were given. By its number in the model; throws
  /// std::out_of_range for one that no body has.
  Frame<double> frame(int body) const { return frame_of(evaluator_, now_.q, body); }
  const DrivenSolver& solver() const { return solver_; }
  /// To look at the neighbourhood of a row once the run is over.
  DrivenSolver& solver() { return solver_; }
  /// Whether some row of the last run lies where the motion is interpolated across a singular position.
  bool interpolated() const { return run_.interpolated; }
  /// The singular configurations met so far, in the order in which they were met.
  const std::vector<SingularPoint>& singular_points() const { return singular_points_; }

 private:
  // Assembly and the start of a motion.
  bool assemble_nearby();
  Report get_ready(double direction);
  Report prepare(double direction);
  Report start_singular(SingularPoint point, double direction);
  void solve_here();
  // Rows: kinematics_run.cpp.
  Report begin_run(const TimeGrid& grid, const Needs& needs, const TimeRange& whole, AnalysisReport& report);
  Report go_to_row(double t, std::vector<std::string>& warnings);
  Report give_row(const Needs& needs, bool check_rates);
  void end_run(const Report& outcome, const Needs& needs, AnalysisReport& report);
  Report cancelled() const;
  // Rates and multipliers at the present instant: kinematics_rates.cpp.
  DrivenInstant here() const;
  Report find_rates(const Needs& needs);
  bool find_velocity();
  bool choose_better_rows();
  Report check_redundant_rates(double allowed, bool in_words);

  // Steps: kinematics_march.cpp.
  enum class StepOutcome { made, dipped, too_long, crossed, left_curve, jumped };
  struct Pace;
  Report follow_to(double t);
  Report go_along_bridge(double t, Pace& pace);
  StepOutcome try_step(double t, bool ignore_dips);
  Report take_step(double next, double target, Pace& pace);
  Report shorten_step(StepOutcome outcome, double next, double target, Pace& pace, Report& passed);
  bool leaves_curve(double t);
  bool contacts_jump(double t);
  Report jumped() const;
  void remember_margins();
  bool predict(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const;

  // Where no step can be made any more: kinematics_lock_up.cpp.
  Report stuck(double next, double target);
  Report lock_up(SingularPoint point);
  std::optional<SingularPoint> dead_point_here();
  bool locate_lock_up(double target, SingularPoint& point);
  bool locate_at_infinity(double target, std::span<const double> w, SingularPoint& point);
  void give_row_at_lock_up(const Needs& needs, RowObserver& observer);

  // Work along the motion: kinematics_work.cpp.
  Report start_work();
  double stretch_length(double limit) const;
  void see_end_of_stretch(bool first, Side inside);
  Report sum_up_stretch(double t, double& error, std::vector<std::string>& warnings);
  Report move_and_sum_up(double t);

  // Singular configurations: kinematics_passage.cpp, kinematics_entry.cpp.
  enum class Passage { none, regular, passed, failed };
  struct Crossing;
  bool add_node(MotionBridge& bridge, double t, double allowed);
  bool build_bridge(MotionBridge& bridge, double centre, double h, double reach);
  bool follows_constraints(const MotionBridge& bridge, double from, double to);
  SingularPoint look_at(const Crossing& crossing, double t);
  double bridge_length(double centre, double reach);
  bool build_crossing(Crossing& crossing, double next, double target, double reach);
  void centre_crossing(Crossing& crossing, double instant, double target, double reach);
  Passage pass_singular(double next, double target, double reach, Report& report);
  bool take_point(SingularPoint point, Report& report);
  Passage follow_bridge(const MotionBridge& bridge, double t);
  void announce(const SingularPoint& point, Report& report);
  struct Entry;
  Report take_branch(const SingularPoint& point, int branch, double direction);
  bool add_along_tangent(const Entry& entry, MotionBridge& bridge, double t);
  bool build_entry(const Entry& entry, bool around, double h, double reach, MotionBridge& bridge);
  void leave_bridge(double end);
  void place_on_bridge(double t);

  std::shared_ptr<const Model> model_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  KinematicsOptions options_;
  FixedCoordinates fixed_;
  DrivenSolver solver_;
  RowChoice rows_;
  DrivenReactions reactions_;
  WatchedElements watched_;
  Predictor predictor_;
  MarginHistory margins_;
  WorkSum work_;

  /// Where the motion is.
  struct Motion {
    double t = 0;
    std::vector<double> q, qd, qdd;
    bool has_velocity = false, has_acceleration = false;
    bool on_bridge = false;  ///< taken from the bridge
  } now_;
  std::vector<double> trial_;
  NewtonOutcome newton_;
  std::optional<AssemblyOutcome> assembled_;
  bool prepared_ = false, placed_ = false;  // the constraints drive it; the solver is where now_.q is

  /// Rates predicted for the instant t, of the sizes that are needed.
  struct PredictedRates {
    std::optional<double> t;
    std::vector<double> qd, qdd;
  } predicted_;
  /// The places on curves: that of the motion (empty: not looked at yet, or there are none); and on those that end,
  /// where a step begins, halfway, and where it ends.
  struct CurvePlaces {
    std::vector<CurvePlace> found;
    std::vector<double> places[3], halfway;
    std::vector<CurvePlace> ends;  ///< of a step that is looked at
    int jumping = -1;              ///< the element whose contact jumped in it
  } curves_;
  ContactJumps jumps_;
  /// Of run(): its observer, which may end it between rows (nullptr outside of it), and the instants outside of which
  /// singular configurations are not reported; and whether some row of the last run was interpolated.
  struct Running {
    RowObserver* observer = nullptr;
    double earliest = -std::numeric_limits<double>::infinity();
    double latest = std::numeric_limits<double>::infinity();
    bool interpolated = false;
  } run_;
  BridgedStretch stretch_;
  std::vector<SingularPoint> singular_points_;
};

}  // namespace catena
