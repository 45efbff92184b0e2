// dynamics: motion under forces over time.
#include "catena/analysis/dynamics.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {

void run_dynamics(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  Report refused;
  const std::optional<TimeGrid> grid = time_grid(context, refused);
  if (!grid) {
    static_cast<Report&>(result.report) = refused;
    return;
  }
  if (!task.events.empty()) {
    result.report.status = Status::refused;
    result.report.message = "\"events\" are not built yet; leave them out";
    return;
  }
  constexpr IntegrationMethod methods[] = {IntegrationMethod::automatic, IntegrationMethod::rk8,
                                           IntegrationMethod::rk5};
  DynamicsOptions options;
  options.method = methods[task.word("method")];
  options.tolerance = task.number("tolerance", options.tolerance);
  options.step = task.number("step", 0);
  const std::vector<std::string> names = task.output_names();
  Dynamics analysis(context.model, plan_options(*context.model, names), options);
  const ColumnSet columns = ColumnSet::resolve(*context.model, analysis.plan(), names,
                                               {.analysis = task.type(),
                                                .timed = true,
                                                .velocity = true,
                                                .acceleration = true,
                                                .multipliers = true,
                                                .work = true});
  analysis.start_from(context.state);
  ReportingRows rows(columns, context, grid->size());
  AnalysisReport report = analysis.run(*grid, columns.needs(), rows);
  context.state = analysis.state();
  take_report(result, std::move(report), &columns, rows.rows());
}

}  // namespace catena
