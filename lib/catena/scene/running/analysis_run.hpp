// One analysis of a scene: its input and output, and the table from types to functions that run them.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/run/time_grid.hpp"
#include "catena/columns/column_set.hpp"
#include "catena/results/analysis_result.hpp"
#include "catena/results/column_rows.hpp"
#include "catena/results/pose_sink.hpp"
#include "catena/scene/reading/analysis_task.hpp"
#include "catena/scene/running/gap_watch.hpp"
#include "catena/scene/running/gear_check.hpp"
#include "catena/scene/running/scene_checkpoints.hpp"

namespace catena {

struct AnalysisContext {
  const AnalysisTask& task;
  std::shared_ptr<const Model> model;
  SystemState& state;  ///< where the analysis starts; it leaves behind where it ended
  RowSink& rows;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(double)> progress;  ///< fraction done
  bool verbose = false;                  ///< solvers print their own logs to standard error
  IterationTrace trace{};                ///< told of iterations for a configuration; may be empty
  /// The model with another value of parameter number `parameter`, all else as in `model`; nullptr if the scene does
  /// not allow it.
  std::function<std::shared_ptr<const Model>(int parameter, double value)> model_at{};
  std::string_view parameter_name{};  ///< of the task's parameter
  /// The value of that parameter with which the analysis ended, and with which the next one begins.
  std::optional<double> parameter_at_end{};
  bool estimate_error = false;              ///< of dynamics
  CheckpointRequest* checkpoint = nullptr;  ///< nullptr: no analysis has to pause
  PoseSink* poses = nullptr;                ///< nullptr: nobody draws
};

using AnalysisFunction = void (*)(AnalysisContext& context, AnalysisResult& result);

void run_check(AnalysisContext& context, AnalysisResult& result);
void run_assemble(AnalysisContext& context, AnalysisResult& result);
void run_kinematics(AnalysisContext& context, AnalysisResult& result);
void run_inverse_dynamics(AnalysisContext& context, AnalysisResult& result);
void run_dynamics(AnalysisContext& context, AnalysisResult& result);
void run_equilibrium(AnalysisContext& context, AnalysisResult& result);
void run_modes(AnalysisContext& context, AnalysisResult& result);
void run_path(AnalysisContext& context, AnalysisResult& result);
void run_buckling(AnalysisContext& context, AnalysisResult& result);

/// The function that runs an analysis of this type; nullptr if none does.
AnalysisFunction analysis_function(std::string_view type);

/// The instants at which the task wants rows, or nothing, with the report refused: before the present time, or outside
/// the table of a function of time.
std::optional<TimeGrid> time_grid(const AnalysisContext& context, Report& report);
/// The instant at which a static analysis is made.
double frozen_time(const AnalysisContext& context);

/// Passes rows on and reports the progress of the analysis.
class ReportingRows final : public RowObserver {
 public:
  /// `last`: the instant at which the analysis ends, or the present one.
  ReportingRows(const ColumnSet& columns, AnalysisContext& context, double last)
      : rows_(columns, context.rows, context.cancel), context_(context), first_(context.state.t), last_(last) {}

  bool observe(const Snapshot& snapshot) override {
    tell(snapshot.t);
    if (context_.poses) context_.poses->pose(snapshot);
    if (gaps) gaps->observe(snapshot);
    return rows_.observe(snapshot);
  }
  bool proceed(double t) override {
    tell(t);
    return !(context_.cancel && context_.cancel->load(std::memory_order_relaxed));
  }
  std::int64_t rows() const { return rows_.rows(); }
  GapWatch* gaps = nullptr;  ///< looks at the rows too; may be none

 private:
  void tell(double t) const {
    if (context_.progress)
      context_.progress(last_ == first_ ? 1 : std::clamp((t - first_) / (last_ - first_), 0.0, 1.0));
  }

  ColumnRows rows_;
  AnalysisContext& context_;
  double first_, last_;
};

/// Ends an analysis whose request cannot be met.
inline void refuse(AnalysisResult& result, std::string message) {
  result.report.status = Status::refused;
  result.report.message = std::move(message);
}

/// What an analysis must compute for its columns and for those who draw; the latter get what it can give.
Needs needs_of(const AnalysisContext& context, const ColumnSet& columns, const ColumnSources& sources);

/// The names whose reactions must be solved for, as plan options.
PlanOptions plan_options(const Model& model, const std::vector<std::string>& outputs);

/// Takes over the report of an analysis, in the order: outcome, columns, notes.
void take_report(AnalysisResult& result, AnalysisReport report, const ColumnSet* columns, std::int64_t rows);

/// Runs an analysis that goes through time, from the present state, and leaves the state where it ended.
template <class Analysis>
void run_over_time(AnalysisContext& context, AnalysisResult& result, Analysis& analysis, const TimeGrid& grid,
                   const std::vector<std::string>& outputs, const ColumnSources& sources) {
  // Of the model that is analysed: motion with friction adds equations to that of the scene.
  const ColumnSet columns = ColumnSet::resolve(analysis.evaluator().model(), analysis.plan(), outputs, sources);
  analysis.start_from(context.state);
  if (context.trace) analysis.evaluator().trace = &context.trace;
  ReportingRows rows(columns, context, grid.last());
  GapWatch gaps(*context.model);
  if (sources.analysis != "dynamics") rows.gaps = &gaps;
  AnalysisReport report = analysis.run(grid, needs_of(context, columns, sources), rows);
  for (std::string& doubt : gaps.warnings()) report.warnings.push_back(std::move(doubt));
  for (std::string& doubt : gears_that_do_not_fit(analysis.evaluator())) report.warnings.push_back(std::move(doubt));
  context.state = analysis.state();
  take_report(result, std::move(report), &columns, rows.rows());
}

}  // namespace catena
