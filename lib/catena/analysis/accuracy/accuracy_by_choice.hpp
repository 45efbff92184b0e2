// How many digits are right of a motion whose method is chosen on the way: by the error that is carried along with its
// steps (motion_accuracy.hpp), or by a second run (second_run.hpp) where that was lost, as with the implicit steps that
// took over, or with explicit ones that stiffness bounds. Which of the two it is to be is known after the run alone, so
// that both see its rows. Where the error that is carried along may be more than was promised, the second run tells how
// far the motion is off: that is an estimate, the other one a bound, which is too large by eighty at the median.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "catena/analysis/run/row_accuracy.hpp"

namespace catena {

class AccuracyByChoice final : public RowAccuracy {
 public:
  /// `turned`: whether steps took over along which no error is carried; `may_repeat`: whether a second run passes what
  /// the first one did; `doubted`: whether the second run is to tell how far the motion is off. All after the run.
  AccuracyByChoice(std::unique_ptr<RowAccuracy> carried, std::unique_ptr<RowAccuracy> second,
                   std::function<bool()> turned, std::function<bool()> may_repeat, std::function<bool()> doubted)
      : carried_(std::move(carried)),
        second_(std::move(second)),
        turned_(std::move(turned)),
        may_repeat_(std::move(may_repeat)),
        doubted_(std::move(doubted)) {}

  void take(const Snapshot& snapshot, std::span<const double> values) override {
    carried_->take(snapshot, values);
    second_->take(snapshot, values);
  }
  std::vector<double> digits(const AnalysisReport& report) override {
    std::vector<double> all;
    if (!turned_()) all = carried_->digits(report);
    repeats_ = all.empty() && report.ok() && may_repeat_();
    if (repeats_) return second_->digits(report);
    if (report.ok() && doubted_()) {
      second_->digits(report);
      doubt_ = second_->doubt();
    }
    return all;
  }
  std::string why_none() const override { return repeats_ ? second_->why_none() : carried_->why_none(); }
  std::string doubt() const override { return repeats_ ? second_->doubt() : doubt_; }

 private:
  std::unique_ptr<RowAccuracy> carried_, second_;
  std::function<bool()> turned_, may_repeat_, doubted_;
  std::string doubt_;
  bool repeats_ = false;
};

}  // namespace catena
