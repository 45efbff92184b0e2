// kinematics and inverse_dynamics: a driven mechanism over time.
#include "catena/analysis/kinematics.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {
namespace {

void run(AnalysisContext& context, AnalysisResult& result, bool inverse_dynamics) {
  const AnalysisTask& task = context.task;
  Report refused;
  const std::optional<TimeGrid> grid = time_grid(context, refused);
  if (!grid) {
    static_cast<Report&>(result.report) = refused;
    return;
  }
  if (task.word("free") != 0 || task.has("branch")) {
    result.report.status = Status::refused;
    result.report.message = task.has("branch") ? "choosing a branch is not built yet; leave \"branch\" out"
                                               : "\"free\": \"minimum_norm\" is not built yet; add drivers instead";
    return;
  }
  const std::vector<std::string> names = task.output_names();
  KinematicsOptions options;
  options.inverse_dynamics = inverse_dynamics;
  Kinematics analysis(context.model, plan_options(*context.model, names), options);
  const ColumnSet columns = ColumnSet::resolve(*context.model, analysis.plan(), names,
                                               {.analysis = task.type(),
                                                .timed = true,
                                                .velocity = true,
                                                .acceleration = true,
                                                .multipliers = inverse_dynamics});
  analysis.start_from(context.state);
  ReportingRows rows(columns, context, grid->size());
  AnalysisReport report = analysis.run(*grid, columns.needs(), rows);
  context.state = analysis.state();
  take_report(result, std::move(report), &columns, rows.rows());
}

}  // namespace

void run_kinematics(AnalysisContext& context, AnalysisResult& result) { run(context, result, false); }
void run_inverse_dynamics(AnalysisContext& context, AnalysisResult& result) { run(context, result, true); }

}  // namespace catena
