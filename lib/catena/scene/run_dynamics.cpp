// dynamics: the motion that follows from forces.
#include "catena/analysis/dynamics.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {

void run_dynamics(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  if (!task.events.empty()) return refuse(result, "events are not built yet; leave \"events\" out");
  const std::optional<TimeGrid> grid = time_grid(context, result.report);
  if (!grid) return;
  // In the order of the key's words.
  constexpr IntegrationMethod methods[] = {IntegrationMethod::automatic, IntegrationMethod::rk8,
                                           IntegrationMethod::rk5};
  DynamicsOptions options;
  options.method = methods[task.word("method")];
  options.tolerance = task.number("tolerance", options.tolerance);
  options.step = task.number("step", options.step);
  const std::vector<std::string> names = task.output_names();
  Dynamics analysis(context.model, plan_options(*context.model, names), options);
  run_over_time(context, result, analysis, *grid, names,
                {.analysis = task.type(),
                 .timed = true,
                 .velocity = true,
                 .acceleration = true,
                 .multipliers = true,
                 .work = true});
}

}  // namespace catena
