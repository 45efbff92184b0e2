// What an analysis of a scene gives at its rows: columns to the sink, derivatives of them where they are asked for,
// measures of the motion between them, and how far it has come.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "catena/analysis/adjoint/measure_adjoint.hpp"
#include "catena/analysis/measures/measure_set.hpp"
#include "catena/analysis/motion/stage_watcher.hpp"
#include "catena/analysis/run/row_accuracy.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/sensitivity/phases/cable_kinks.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"
#include "catena/results/analysis_result.hpp"
#include "catena/scene/judging/gap_watch.hpp"

namespace catena {

struct AnalysisContext;

class AnalysisRows final : public RowObserver {
 public:
  /// `run`: the first and the last instant. `columns` and `context` must outlive this object.
  AnalysisRows(const ColumnSet& columns, AnalysisContext& context, const Model& model, const Plan& plan,
               const ColumnSources& sources, const TimeRange& run);
  ~AnalysisRows() override;

  /// Derivatives of rows and measures are wanted, and this is how they are found; before begin().
  void differentiate(std::unique_ptr<StateDerivatives> derivatives);
  /// Gradients of measures are wanted alone, and found by the way back of the motion; before begin().
  template <class Back>
  void differentiate_back(std::unique_ptr<Back> derivatives) {
    back_ = derivatives.get();
    differentiate(std::move(derivatives));
    measures_.give_pulses();
  }
  /// How the mechanism is looked at between rows, where the analysis does not show it by itself; before begin(). It is
  /// made at the first row, from its snapshot.
  using Look = std::function<std::optional<Snapshot>(double)>;
  void look_by(std::function<Look(const Snapshot&)> make) { make_look_ = std::move(make); }
  /// The snapshots that are drawn, if they differ from those of the rows; before begin(). What it gives is valid until
  /// the next call; where it gives nothing the row is drawn as it is.
  using Drawn = std::function<std::optional<Snapshot>(const Snapshot&)>;
  void draw_by(Drawn drawn) { drawn_ = std::move(drawn); }
  /// There are no snapshots between rows: measures are those of the rows, and say so.
  void take_rows_alone() { rows_alone_ = true; }
  /// One-sided elements do not take part in the analysis: the rows tell which of them are violated.
  void watch_gaps(const Model& model) { gaps_.emplace(model); }
  /// Finds how many digits of the columns are right.
  void judge(std::unique_ptr<RowAccuracy> accuracy) { accuracy_ = std::move(accuracy); }
  /// Announces the columns to the sink.
  void begin();

  /// Of the columns, of what measures look at, and of drawings, unless these have snapshots of their own.
  Needs needs() const;
  /// Of what measures look at alone.
  Needs measured_needs() const { return measures_.empty() ? Needs{} : measures_.needs(); }
  /// Of the columns and of what measures look at.
  Needs asked_needs() const;
  /// What drawings need of what this analysis can give.
  Needs drawn_needs() const;
  bool observe(const Snapshot& snapshot) override;
  bool proceed(double t) override;
  bool wants_stretches() const override {
    return timed_ && !rows_alone_ && !make_look_ && (!measures_.empty() || derivatives_);
  }
  bool cover(const MotionStretch& stretch) override;
  StageWatcher* stage_watcher() override {
    return wants_stretches() && derivatives_ ? derivatives_->stage_watcher() : nullptr;
  }

  std::int64_t rows() const { return rows_; }
  const ColumnSet& columns() const { return columns_; }
  /// Columns, rows, measures and what is to be said of them, after the report was taken over; the last call.
  void finish(AnalysisResult& result);

 private:
  void tell(double t) const;
  void cover_parts(const MotionStretch& stretch, std::span<const double> ends);
  void draw(const Snapshot& snapshot) const;
  /// Between rows, in stretches of as many rows as the motion is smooth over.
  void look_since_last_row(const Snapshot& snapshot);
  void look_at_what_is_left();
  void leave_out_at_instant(double t);
  /// Why a measure's derivative is missing.
  std::string why_no_derivative() const;
  /// How the instants of the run and its measures move with the parameters. `results`: of all measures and of the
  /// columns of events that stop.
  MovingInstants moving_instants(const std::vector<MeasureResult>& results) const;
  std::vector<double> end_by_event(const std::vector<MeasureResult>& results, std::string& why) const;
  std::vector<MeasureResult> measured() const;
  /// Gradients of all that is measured by the way back; nothing where there are none, and the context is told why.
  std::optional<MeasureAdjoint::MeasureGradients> gradients_back() const;

  const ColumnSet& columns_;
  AnalysisContext& context_;
  MeasureSet measures_;
  std::unique_ptr<StateDerivatives> derivatives_;
  MeasureAdjoint* back_ = nullptr;  // the same, where they go back
  CableKinks cables_;
  std::function<Look(const Snapshot&)> make_look_;
  Look look_;
  Drawn drawn_;
  std::optional<GapWatch> gaps_;
  std::unique_ptr<RowAccuracy> accuracy_;
  ColumnSources sources_;
  std::vector<ColumnInfo> info_;
  std::vector<double> values_, row_gradients_;  // of one row, kept for their memory
  bool timed_, row_derivatives_ = false, rows_alone_ = false;
  double first_, last_;
  double covered_to_, reached_;  // how far measures have looked between rows, and rows have come
  std::int64_t rows_ = 0;
  struct {
    std::int64_t rows = 0;
    std::string jump;               // why columns have none in the first row that lacks some for a jump
    std::string measured_jump;      // the same of instants at which measures look
  } missing_;                       // derivatives
  std::vector<std::size_t> stops_;  // events that stop it, whose columns are measured after all that is asked for
};

}  // namespace catena
