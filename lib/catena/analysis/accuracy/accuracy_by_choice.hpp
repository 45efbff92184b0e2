// How many digits are right of a motion whose method is chosen on the way: by the error that is carried along with its
// steps (motion_accuracy.hpp), or by a second run (second_run.hpp) where that was lost, as with the implicit steps that
// took over, or with explicit ones that stiffness bounds. Which of the two it is to be is known after the run alone, so
// that both see its rows.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "catena/analysis/run/row_accuracy.hpp"

namespace catena {

class AccuracyByChoice final : public RowAccuracy {
 public:
  /// `turned`: whether steps took over along which no error is carried; `may_repeat`: whether a second run passes what
  /// the first one did. Both after the run.
  AccuracyByChoice(std::unique_ptr<RowAccuracy> carried, std::unique_ptr<RowAccuracy> second,
                   std::function<bool()> turned, std::function<bool()> may_repeat)
      : carried_(std::move(carried)),
        second_(std::move(second)),
        turned_(std::move(turned)),
        may_repeat_(std::move(may_repeat)) {}

  void take(const Snapshot& snapshot, std::span<const double> values) override {
    carried_->take(snapshot, values);
    second_->take(snapshot, values);
  }
  std::vector<double> digits(const AnalysisReport& report) override {
    std::vector<double> all;
    if (!turned_()) all = carried_->digits(report);
    repeats_ = all.empty() && report.ok() && may_repeat_();
    return repeats_ ? second_->digits(report) : all;
  }
  std::string why_none() const override { return repeats_ ? second_->why_none() : carried_->why_none(); }
  std::string doubt() const override { return repeats_ ? second_->doubt() : carried_->doubt(); }

 private:
  std::unique_ptr<RowAccuracy> carried_, second_;
  std::function<bool()> turned_, may_repeat_;
  bool repeats_ = false;
};

}  // namespace catena
