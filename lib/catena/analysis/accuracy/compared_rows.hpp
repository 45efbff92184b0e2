// How many digits of the columns of a motion are right, from the rows of two runs of which one is finer
// (dynamics/error_estimate.hpp).
//
//   e = 3 |c(finer) - c(asked)| + 64 eps |c|      the error of the coarser run, up to that of the finer one
//
// largest of all rows, and at least what rounding makes of a column of its unit (motion_rounding.hpp): of a body that
// is held both runs give the rounding of its velocity, of which no digit is right. The rows given are those of the
// finer run and more accurate by what a tenth of the tolerance or half the step is worth, up to 10. In a single column
// the errors of both may agree by chance: of 6720 columns of 400 random mechanisms two were off by 10 to 19
// differences, hence the three. What both have in common, the rounding of the start and of a few hundred steps, is the
// rest. Rows at events, which both runs have at instants of their own, are not compared; a run whose rows were not all
// compared claims nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "catena/analysis/accuracy/motion_accuracy.hpp"
#include "catena/analysis/accuracy/motion_rounding.hpp"
#include "catena/analysis/run/row_accuracy.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

class ComparedRows final : public RowAccuracy, public RowObserver {
 public:
  /// `evaluator`: that of the finer run, after it. `columns` must outlive this object.
  ComparedRows(const ColumnSet& columns, std::function<Evaluator&()> evaluator)
      : columns_(columns), evaluator_(std::move(evaluator)), errors_(columns.size()), asked_(columns.size()) {}

  /// The row of the run that was asked for, before the finer one's.
  bool observe(const Snapshot& snapshot) override {
    columns_.evaluate(snapshot, asked_);
    t_ = snapshot.t;
    return true;
  }
  void take(const Snapshot& snapshot, std::span<const double> values) override {
    errors_.take_row(values);
    fastest_ = std::max(fastest_, fastest_rate(snapshot, snapshot.evaluator.length_scale()));
    if (t_ != snapshot.t) {
      all_compared_ = false;
      return;
    }
    for (std::size_t k = 0; k < asked_.size(); ++k) {
      const bool same = std::isnan(values[k]) && std::isnan(asked_[k]);
      if (!same) errors_.take_error(k, factor * std::abs(values[k] - asked_[k]) + common * std::abs(values[k]));
    }
  }
  std::vector<double> digits(const AnalysisReport& report) override {
    if (!report.ok() || !all_compared_) return {};
    Evaluator& evaluator = evaluator_();
    MotionRounding rounding(evaluator);
    rounding.take_rate(fastest_);
    for (std::size_t k = 0; k < asked_.size(); ++k) {
      // What is zero in every row of both is held by nothing that rounds.
      if (errors_.error(k) > 0) errors_.take_error(k, rounding.least_error(columns_.info()[k].unit));
    }
    errors_.take_places(columns_.info(), evaluator.length_scale());
    return MotionAccuracy::claimed(errors_);
  }

 private:
  // See the head of this file.
  static constexpr double factor = 3, common = thresholds::sum_rounding;
  const ColumnSet& columns_;
  std::function<Evaluator&()> evaluator_;
  ColumnErrors errors_;
  std::vector<double> asked_;
  std::optional<double> t_;
  double fastest_ = 0;  // rad/s
  bool all_compared_ = true;
};

}  // namespace catena
