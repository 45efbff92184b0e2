// The measures of one analysis at work: they look at its rows and at the motion between them, and give values, instants
// and gradients at the end.
//
// Analyses in time show stretches of their motion (cover()); others give rows alone (take_row()). With derivatives of
// columns at hand, a measure's gradient is
//
//   extremes          that of the column at the fixed instant (at an end of the run as well); a tie of two instants
//                     whose gradients differ has none
//   integrals         sum of weights x gradients at the nodes        mean, rms       from these
//   paths             of each point the nearest instant is fixed     first, final, at
//
// What a run could not be looked at for (between rows of a motion of least norm) is taken from its rows, and `trouble`
// says so; integrals over time have no value there. Neither has a measure that is not a number.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/measures/extreme.hpp"
#include "catena/analysis/measures/measure.hpp"

namespace catena {

class MeasureSet {
 public:
  /// Measures of the kind `field` are passed over. Throws ColumnError, and std::invalid_argument for a measure whose
  /// column the analysis cannot give, or that is none in a plan without time. `run`: the first and the last instant.
  MeasureSet(std::vector<MeasureRequest> requests, const Model& model, const Plan& plan, const ColumnSources& sources,
             const TimeRange& run);
  ~MeasureSet();

  bool empty() const { return requests_.empty(); }
  const ColumnSet& columns() const { return *columns_; }
  const Needs& needs() const { return columns_->needs(); }
  /// Gradients by so many parameters are wanted, from derivatives of columns(); before anything is taken.
  void differentiate(int parameters, DifferentiateColumns derivatives);

  /// A stretch of the motion, one after the other.
  void cover(const MotionStretch& stretch);
  /// How long the next stretch may be where rows do not bound it, s.
  double pace() const;
  /// A row; `only_rows`: there are no stretches.
  void take_row(const Snapshot& snapshot, bool only_rows);

  std::vector<MeasureResult> results() const;

 private:
  class Account;

  TimeRange run_;
  std::vector<MeasureRequest> requests_;
  std::unique_ptr<ColumnSet> columns_;
  std::unique_ptr<MotionSamples> samples_;
  std::vector<std::unique_ptr<Account>> accounts_;
  int parameters_ = 0;
  std::optional<double> earliest_row_;
  bool wants_samples_ = false;  // some measure depends on what is between rows
  bool looked_ = true;          // whether every stretch could be looked at
};

}  // namespace catena
