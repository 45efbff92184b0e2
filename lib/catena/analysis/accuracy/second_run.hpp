// How many digits of the columns of a motion are right, from a second and coarser run behind it.
//
//   e = f d + (r + |t| rate) eps max(|c|, u) + least + drift,   d = |c(asked) - c(coarser)|    largest of the rows
//
// and at least a twentieth of the largest f d of its unit, if the column differs at all. u: of places the length scale
// or 1 rad. r = 8 + 2 sqrt(steps), or with changes 64 + 16 n, n those of the element that has most. Coarser: ten times
// the tolerance, four times that of methods of one step, or steps longer by a quarter, of adams by half
// (coarser_options). Where it takes as many steps, which are then the same, with the same rounding, it is made by
// another method. The rows given are those that were asked for; the difference is the error of the coarser run, up to
// theirs. f: second_run_compared.cpp. eps |t| rate counts where something depends on time, rate that of the fastest
// motion, rad/s. Least: motion_rounding.hpp. Drift: how far the mechanism is off its constraints, m: four times that
// for places, that times the rate for velocities, times its square for accelerations; nothing but rounding where they
// are projected.
//
// Both runs must pass the same changes (motion_changes.hpp); where they do not, nothing is said, and why_none() says
// so. A row that lies as near to a change as the instant of that is uncertain is not judged in the columns that jump
// there:
//
//   |t - t_k| <= w |t_k(asked) - t_k(coarser)| + 1e-9 s_k        s_k: s, of the run up to there
//
// velocities and all that depends on them or on forces at impacts, accelerations and forces at the others; places never
// jump. Such columns claim nothing. Rows at events lie at the instants that each run finds, and are compared there.
//
// It is a run more, of about three quarters of the first one's cost; beyond an allowance of most_work nothing is said.
// Changes that neither run sees, and errors that both have in common, such as a too coarse table of a force, are not
// in it. Rows are kept until it is over: beyond most_numbers of them every other one, and so on.
//
// Where `tolerance` is given, the error of the whole motion is found as well, and doubt() tells where it is more than
// ten tolerances (tolerance_check.hpp).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/accuracy/motion_changes.hpp"
#include "catena/analysis/accuracy/motion_rounding.hpp"
#include "catena/analysis/accuracy/tolerance_check.hpp"
#include "catena/analysis/dynamics/dynamics_options.hpp"
#include "catena/analysis/run/row_accuracy.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

/// The options of the second run.
DynamicsOptions coarser_options(const DynamicsOptions& options);

class SecondRun final : public RowAccuracy {
 public:
  struct Motion {
    AnalysisReport report;
    MotionChanges changes;
    MotionRounding rounding;
    double tolerance = 0;
  };
  struct Runs {
    std::function<MotionChanges()> first;  ///< its changes, after it
    /// Makes it, from the same start; with steps of another method where the coarser ones were the same.
    std::function<Motion(const Needs& needs, RowObserver&, bool by_other_method)> second;
    std::function<bool()> proceed;  ///< false: cancelled
    double tolerance = 0;           ///< of the first one, where its error is told by doubt()
  };
  /// `columns` must outlive this object. `leaves_constraints`: the method does not project onto them.
  SecondRun(const ColumnSet& columns, Runs runs, bool leaves_constraints)
      : columns_(columns), runs_(std::move(runs)), errors_(columns.size()), leaves_constraints_(leaves_constraints) {}

  void take(const Snapshot& snapshot, std::span<const double> values) override;
  std::vector<double> digits(const AnalysisReport& report) override;
  std::string why_none() const override { return why_; }
  std::string doubt() const override { return doubt_; }

 private:
  class OtherRows;
  /// What of columns may jump where a row lies.
  enum class Jump : unsigned char { none, of_forces, of_rates };
  void thin_out();
  void compare_with_tolerance(const OtherRows& other, double tolerance);
  void compare(const OtherRows& other, const MotionRounding& rounding, double common);
  void find_jumps(const MotionChanges& first, const MotionChanges& second, const OtherRows& other);
  bool is_judged(UnitKind unit, std::size_t row) const;
  void take_motion(const Snapshot& snapshot);
  double error_of_drift(UnitKind unit) const;
  double largest_difference(const OtherRows& other, std::size_t column) const;
  double rounded_size(UnitKind unit, double value) const;

  const ColumnSet& columns_;
  Runs runs_;
  ColumnErrors errors_;
  bool leaves_constraints_;
  std::string why_, doubt_;
  struct {
    std::vector<double> t, values;      // of the rows that are kept
    std::int64_t given = 0, every = 1;  // of all rows one in so many is kept
    ToleranceCheck places;
  } rows_;
  struct {
    double drift = 0, length = 1, rate = 0, fastest = 0, first = 0;  // m, m, 1/s, rad/s, s
    std::size_t coordinates = 0;
    bool timed = false;
  } motion_;
  std::vector<Jump> jumps_;  // by the rows that are kept
};

}  // namespace catena
