// How many digits of the columns of a motion are right, of one run: from the error that is carried along with it
// (carried_error.hpp).
//
//   e = 2.3 max (|c(y + e + r) - c(y)|, |c(y + e - r) - c(y)|) / s + 4 eps |c|        largest of the rows looked at
//
// r: at random, 0.2 of the largest part of e in every coordinate and the rounding of places and rates, as far as the
// constraints allow it: the error that is carried has a direction that is right by its size only. With functions of
// time also the way of the motion in eps |t|: columns, forces and constraints are those at t (1 +- eps). Accelerations
// and multipliers are those at y + e + r with the rounding of their equations (kinematic_accuracy.hpp). All is made so
// small, or large, by s, that its effect is in proportion. Rows: where e has grown by a quarter since the last one, as
// far as the allowance goes, the last of all, that of the largest accelerations, and with functions of time four of the
// later half. Nothing is said of work, which is summed up over time, of reactions where equations depend on each other,
// and where the error is lost.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "catena/analysis/accuracy/carried_error.hpp"
#include "catena/analysis/accuracy/row_terms.hpp"
#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/analysis/run/row_accuracy.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

class MotionAccuracy final : public RowAccuracy {
 public:
  /// Of the rows of analysis.run(), which it follows; both must outlive this object, and it the run.
  MotionAccuracy(Dynamics& analysis, const ColumnSet& columns);
  /// The same as long as no event acts; the instants at which others happen are not judged. Without contacts.
  MotionAccuracy(DynamicsWithEvents& analysis, const ColumnSet& columns);
  ~MotionAccuracy() override { motion_.follow(nullptr); }
  MotionAccuracy(const MotionAccuracy&) = delete;
  MotionAccuracy& operator=(const MotionAccuracy&) = delete;

  void take(const Snapshot& snapshot, std::span<const double> values) override;
  std::vector<double> digits(const AnalysisReport& report) override;
  std::string why_none() const override;
  /// Of the columns of a run that ended so; nullptr: nothing is known.
  const ColumnErrors* errors(const AnalysisReport& report);
  /// Largest error of places of all rows, in length scales or rad; NaN: not known.
  double error_of_places() const;
  /// Digits as they are claimed: none where errors have no effect in proportion any more.
  static std::vector<double> claimed(const ColumnErrors& errors);

 private:
  struct Row {
    double t = 0, rate = 0;
    std::vector<double> q, qd, values, error;
  };
  void keep();
  void keep_sharpest(std::span<const double> qdd);
  void examine(const Row& row);
  double disturb_time(const Row& row);
  void disturb(const Row& row, double size);
  bool values_at(const Row& row, double size);
  bool solve_accelerations(double t, double size, Snapshot& snapshot);
  void add_change_with_time(double t, double size, std::span<double> gamma);

  MotionAccuracy(const Evaluator& evaluator, const ColumnSet& columns);
  template <class Analysis>
  void follow(Analysis& analysis);

  struct {
    std::function<void(StepFollower*)> follow = [](StepFollower*) {};
    std::function<bool()> is_smooth;  // whether it passed neither jumps nor singular positions
  } motion_;
  const ColumnSet& columns_;
  CarriedError carried_;
  ColumnErrors errors_;
  Disturbance random_;
  Row row_;
  struct {
    double size = 0;       // norm of the error in the row that was looked at last
    bool is_last = false;  // whether that is the last row so far
  } examined_;
  RowTerms terms_;
  double places_ = 0;            // error_of_places() so far
  bool curves_;                  // of rows before the last it is not known where they touched
  bool timed_;                   // something depends on time, and rows before the last are looked at
  bool finds_instants_ = false;  // some rows lie at instants that the motion decides on
  // The last rows, whose errors are largest as errors grow, are kept beside the one of the largest accelerations.
  static constexpr int late_rows = 4;
  struct {
    std::array<Row, late_rows + 1> rows;  // late ones, and the one of the largest accelerations
    int oldest = 0;
    double sharpest = 0;               // 1/s^2
    std::int64_t count = 0, next = 1;  // of rows so far; the one that is kept next
  } kept_;
  // Of a disturbed state.
  std::vector<double> disturbance_, q_, qd_, qdd_, lambda_, jacobian_, loads_, gamma_, change_, change_lambda_;
  std::vector<double> other_, largest_, unknown_, moduli_;
};

}  // namespace catena
