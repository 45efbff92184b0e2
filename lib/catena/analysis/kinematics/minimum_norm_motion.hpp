// Kinematics of a mechanism that its drivers do not determine: of all motions the one with the smallest velocities.
//
//   q' = v(t, q),   v = least_velocity.hpp's qd
//
// integrated by the method of order 8 of Dormand and Prince (tableau.hpp), every step ending on the constraints by the
// least change: the path does not depend on how far apart rows are. Bodies that no driver moves stay where they are.
// The path depends on the metric, and after a closed motion of the drivers the mechanism need not be where it began. No
// loads: free motions would need forces of their own.
// Where branches meet the motion continues along its own branch: instead of very short steps one step is made across
// the place, with its stages projected onto the constraints. Such places are passed, not located.
// Singular where the drivers prescribe a motion that no velocity meets (lock-up: an arm stretched out), reported with
// its instant and a last row for the place; where rows become dependent without that, steps shrink and the report says
// `singular`.
#pragma once

#include <memory>
#include <optional>

#include "catena/analysis/pose/branches.hpp"
#include "catena/analysis/pose/least_velocity.hpp"
#include "catena/analysis/run/analysis_report.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/run/time_grid.hpp"
#include "catena/analysis/run/watched_elements.hpp"

namespace catena {

class MinimumNormMotion {
 public:
  explicit MinimumNormMotion(std::shared_ptr<const Model> model, const PlanOptions& plan_options = {});

  const Plan& plan() const { return *plan_; }
  Evaluator& evaluator() { return evaluator_; }
  /// Starts from a state of an earlier analysis instead of the given configuration at t = 0.
  void start_from(const SystemState& state);
  /// Assembles at the first instant and goes through the grid.
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);
  /// The present state, absolute and in model order; velocities if they are known.
  SystemState state() const;
  /// Where the motion could not go on, if so.
  const std::vector<SingularPoint>& singular_points() const { return singular_points_; }

 private:
  Report prepare(AnalysisReport& report);
  struct Leg;
  Leg next_leg(double t) const;
  Report move_to(double t, RowObserver& observer);
  Report make_step(const Leg& leg, double target);
  void take_step(double end, double way);
  bool evaluate_stages(double h, double end, bool lands_on_break, bool on_constraints);
  double error_size(double h) const;
  double try_step(double end, bool lands_on_break, bool on_constraints);
  std::optional<double> jump(double limit, bool breaks, double rate);
  Report solve_rates(const Needs& needs);
  Report no_velocity();
  Report stuck_at_start(double target);
  Report cancelled() const;
  Report stuck(double target);
  void give_row_at_lock_up(const Needs& needs, RowObserver& observer);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  LeastVelocity least_;
  WatchedElements watched_;
  double t_ = 0, step_ = 0;
  double started_ = 0, travelled_ = 0;  // when it began, and the largest rate integrated since (rad, length scales)
  double residual_ = 0;                 // of positions, in length scales or rad
  bool has_velocity_ = false;
  std::vector<CurvePlace> curve_places_;  // at q_
  std::vector<double> q_, qd_, qdd_, trial_;
  std::vector<std::vector<double>> stage_;
  std::vector<double> error_, error_low_;
  std::vector<SingularPoint> singular_points_;
};

}  // namespace catena
