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
#include "catena/results/pose_sink.hpp"
#include "catena/scene/judging/gear_check.hpp"
#include "catena/scene/judging/idle_keys.hpp"
#include "catena/scene/judging/rope_check.hpp"
#include "catena/scene/models/scene_models.hpp"
#include "catena/scene/reading/analysis_task.hpp"
#include "catena/scene/running/analysis_rows.hpp"
#include "catena/scene/running/field_measures.hpp"
#include "catena/scene/running/scene_checkpoints.hpp"

namespace catena {

/// How gradients are found, in the order of the words of `mode`.
enum class GradientMode { automatic, forward, adjoint };

/// Derivatives that are wanted of an analysis.
struct DesignRequest {
  std::vector<int> parameters;
  std::vector<std::string> names;  ///< of these
  bool rows = true;                ///< of rows as well, not of measures alone: forward
  GradientMode mode = GradientMode::automatic;
};

class ProcessLink;
class SweepRecord;

/// What helps a sweep beside threads.
struct SweepHelp {
  SweepRecord* record = nullptr;  ///< of finished designs, if it is kept
  ProcessLink* link = nullptr;    ///< to other processes that share the work
  double patience = 10;           ///< s of silence after which such a process is lost
  std::string_view owner{};       ///< what a process must agree with to share the work
  int analysis = 0;               ///< number of the sweep among the analyses, from 1
};

struct AnalysisContext {
  const AnalysisTask& task;
  std::shared_ptr<const Model> model;
  SystemState& state;  ///< where the analysis starts; it leaves behind where it ended
  RowSink& rows;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(double)> progress;   ///< fraction done
  bool verbose = false;                   ///< solvers print their own logs to standard error
  IterationTrace trace{};                 ///< told of iterations for a configuration; may be empty
  const SceneModels* models = nullptr;    ///< of the scene, for other values of parameters
  ParameterSeeds seeds{};                 ///< values of parameters besides those of the task's table
  const DesignRequest* design = nullptr;  ///< nullptr: no derivatives
  bool goes_back = false;                 ///< gradients were sought by adjoints
  /// Why gradients are carried forward although the adjoint was asked for; and why the adjoint gave none, so that the
  /// analysis has to be run once more.
  std::string forward_because{}, no_adjoint{};
  std::string_view parameter_name{};  ///< of the task's parameter
  /// Of parameters that a path or an optimisation changed: with these values the next analysis begins. Empty where it
  /// did not succeed.
  ParameterSeeds values_at_end{};
  bool estimate_error = false;              ///< of dynamics
  CheckpointRequest* checkpoint = nullptr;  ///< nullptr: no analysis has to pause
  PoseSink* poses = nullptr;                ///< nullptr: nothing is drawn
  bool digits = false;                      ///< whether to tell how many digits of the columns are right
  int threads = 1;                          ///< that a sweep, or the starts of an optimisation, may use
  SweepHelp sweep{};
};

/// The model with another value of parameter number `parameter`, all else as in the context; nullptr if the scene does
/// not allow it.
std::shared_ptr<const Model> model_at(const AnalysisContext& context, int parameter, double value);
/// Models with derivatives by the parameters of the context's design request, and by one more, `last` >= 0; parameter
/// `at` with another value where one is given.
DesignModels designs_of(const AnalysisContext& context, int last = -1, std::optional<ParameterSeed<double>> at = {});

/// Whether the gradients that the context's design request asks for are found by adjoints: where they can be and,
/// unless they are asked for, where they are the cheaper way. `obstacle`: why this analysis has none, if so;
/// `has_phases`: as AdjointMechanism::why_not().
bool goes_back(AnalysisContext& context, std::string_view obstacle = {}, bool has_phases = false);

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
void run_sensitivity(AnalysisContext& context, AnalysisResult& result);
void run_optimise(AnalysisContext& context, AnalysisResult& result);
void run_sweep(AnalysisContext& context, AnalysisResult& result);

/// Runs the analysis of the context's task. What events of motions before have engaged stays held after it, also where
/// it has no events itself.
void run_analysis(AnalysisContext& context, AnalysisResult& result);

/// The instants at which the task wants rows, or nothing, with the report refused: before the present time, or outside
/// the table of a function of time.
std::optional<TimeGrid> time_grid(const AnalysisContext& context, Report& report);
/// The instant at which a static analysis is made.
double frozen_time(const AnalysisContext& context);

/// Nothing, or why a path or buckling from the state cannot have one-sided elements and ropes: derivatives, ropes that
/// lie otherwise than models at other values of the parameter have them.
std::string trouble_with_one_sided(const AnalysisContext& context, const SystemState& start);

/// Ends an analysis whose request cannot be met.
inline void refuse(AnalysisResult& result, std::string message) {
  result.report.status = Status::refused;
  result.report.message = std::move(message);
}

/// The names whose reactions must be solved for, as plan options; `state`: what is released there has no equations.
PlanOptions plan_options(const Model& model, const std::vector<std::string>& outputs, const SystemState& state = {});
/// The same without equations of one-sided elements.
PlanOptions plan_without_gaps(const Model& model, const std::vector<std::string>& outputs, const SystemState& state);

/// What the result says of the rows that went to the sink.
inline void take_rows(AnalysisResult& result, std::vector<ColumnInfo> columns, std::int64_t rows) {
  result.has_rows = true;
  result.columns = std::move(columns);
  result.rows = rows;
}

/// Runs an analysis that goes through time, from the present state, and leaves the state where it ended. `prepare` gets
/// the rows before the run.
template <class Analysis, class Prepare>
void run_over_time(AnalysisContext& context, AnalysisResult& result, Analysis& analysis, const TimeGrid& grid,
                   const std::vector<std::string>& outputs, const ColumnSources& sources, Prepare&& prepare) {
  // Of the model that is analysed: motion with friction adds equations to that of the scene.
  const Model& model = analysis.evaluator().model();
  const ColumnSet columns = ColumnSet::resolve(model, analysis.plan(), outputs, sources);
  analysis.start_from(context.state);
  // Ropes that are wound further than their places tell have come to be so in an analysis before.
  const bool begins_as_given = context.state.ropes.empty();
  if (context.trace) analysis.evaluator().trace = &context.trace;
  AnalysisRows rows(columns, context, model, analysis.plan(), sources,
                    {std::min(context.state.t, grid.earliest()), grid.latest()});
  prepare(rows);
  rows.begin();
  AnalysisReport report = analysis.run(grid, rows.needs(), rows);
  for (std::string& doubt : gears_that_do_not_fit(analysis.evaluator())) report.warnings.push_back(std::move(doubt));
  if (begins_as_given) {
    for (std::string& doubt : ropes_in_loops(model)) report.warnings.push_back(std::move(doubt));
    for (std::string& doubt : keys_without_effect(model)) report.warnings.push_back(std::move(doubt));
  }
  context.state = analysis.state();
  result.report = std::move(report);
  rows.finish(result);
}

}  // namespace catena
