// Estimates the error of a motion from two runs, made together, of which one is finer.
//
//   asked    the run that was asked for: tolerance, or fixed step
//   finer    tolerance / 10, or half the step; its rows are those that are given
//
// error = largest difference of the two at the instants of rows, of positions, angles, velocities and angular
// velocities of the bodies, at their centroids. It is the error of the requested run, up to that of the finer one; the
// rows given are more accurate. It is valid where small errors have small effects: in chaotic motions after long times
// the difference is large, but no bound. Errors common to both runs, such as a too coarse table of a function of time,
// are not included. Units: m, rad, s; nothing is stored by row.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/analysis/motion/stage_watcher.hpp"

namespace catena {

/// One kind of coordinate. `scale`: what the tolerance of this kind is relative to (see DynamicsOptions).
struct ErrorOfMotion {
  double error = 0;
  double scale = 0;
  int body = -1;  ///< of the model, where it is largest; -1: none at all
  double t = 0;   ///< s, when
  /// Compares with a tolerance.
  double relative() const { return error > 0 ? error / scale : 0; }
};

struct EstimatedError {
  /// Of the tolerance that an error may come to, as methods are calibrated (apps/manual/numerics.md).
  static constexpr double largest_multiple = 10;

  ErrorOfMotion position, angle, velocity, angular_velocity;  ///< m, rad, m/s, rad/s
  double until = 0;                                           ///< s; the last instant at which the two were compared
  double largest() const;                                     ///< relative()
};

/// The options of the finer run. Throws std::invalid_argument where double precision leaves nothing finer.
DynamicsOptions finer_options(const DynamicsOptions& options);

/// Follows the rows of the finer run with the other one, compares, and passes them on.
class ErrorComparison final : public RowObserver {
 public:
  /// `asked` has begun; `target` gets the rows, and before each of them `beside`, if there is one, the same row of the
  /// run that was asked for.
  ErrorComparison(Dynamics& asked, const TimeGrid& grid, RowObserver& target, RowObserver* beside = nullptr);

  bool observe(const Snapshot& snapshot) override;
  bool proceed(double t) override;
  bool wants_stretches() const override { return target_.wants_stretches(); }
  bool cover(const MotionStretch& stretch) override { return target_.cover(stretch); }
  StageWatcher* stage_watcher() override { return target_.stage_watcher(); }
  const EstimatedError& error() const { return error_; }

 private:
  /// Rows of the run that was asked for end here.
  class Other final : public RowObserver {
   public:
    explicit Other(ErrorComparison& owner) : owner_(owner) {}
    bool observe(const Snapshot& snapshot) override;
    bool proceed(double t) override;

   private:
    ErrorComparison& owner_;
  };
  void compare(const Snapshot& snapshot);

  Dynamics& asked_;
  const TimeGrid& grid_;
  RowObserver& target_;
  RowObserver* beside_;
  Other other_{*this};
  EstimatedError error_;
  std::int64_t row_ = 0;
  double t_ = 0;                // reached by the finer run
  bool proceeding_ = true;      // not cancelled
  std::vector<double> q_, qd_;  // of the run that was asked for
};

/// Adds the result of the comparison and its cost to the report of the finer run.
void add_estimate(AnalysisReport& report, const AnalysisReport& asked, const EstimatedError& error,
                  const DynamicsOptions& options);

/// Dynamics, or DynamicsWithEvents whose events do not change the mechanism, with an estimate of its error.
template <class Analysis>
class WithErrorEstimate {
 public:
  /// `finer` has finer_options(options).
  WithErrorEstimate(Analysis& finer, std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                    const DynamicsOptions& options)
      : finer_(finer), asked_(std::move(model), plan_options, options), options_(options) {}

  const Plan& plan() const { return finer_.plan(); }
  Evaluator& evaluator() { return finer_.evaluator(); }
  IntegrationMethod method() const { return finer_.method(); }
  SystemState state() const { return finer_.state(); }
  void start_from(const SystemState& state) {
    finer_.start_from(state);
    asked_.start_from(state);
  }
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
    asked_.begin(grid, beside_ ? needs : Needs{});
    ErrorComparison comparison(asked_, grid, observer, beside_);
    AnalysisReport report = finer_.run(grid, needs, comparison);
    error_ = comparison.error();
    add_estimate(report, asked_.end(), error_, options_);
    return report;
  }
  const EstimatedError& error() const { return error_; }
  /// `beside` gets every row of the run that was asked for, before the finer run's row, with the same quantities.
  void show_asked(RowObserver& beside) { beside_ = &beside; }

 private:
  Analysis& finer_;
  Dynamics asked_;
  DynamicsOptions options_;
  RowObserver* beside_ = nullptr;
  EstimatedError error_;
};

}  // namespace catena
