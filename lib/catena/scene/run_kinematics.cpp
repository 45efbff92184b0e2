// kinematics and inverse_dynamics: a driven mechanism over time.
#include "catena/analysis/kinematics.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {
namespace {

void run(AnalysisContext& context, AnalysisResult& result, bool inverse_dynamics) {
  const AnalysisTask& task = context.task;
  if (task.has("branch")) return refuse(result, "choosing a branch is not built yet; leave \"branch\" out");
  if (task.word("free") != 0) return refuse(result, "\"free\": \"minimum_norm\" is not built yet; add drivers instead");
  const std::optional<TimeGrid> grid = time_grid(context, result.report);
  if (!grid) return;
  const std::vector<std::string> names = task.output_names();
  KinematicsOptions options;
  options.inverse_dynamics = inverse_dynamics;
  Kinematics analysis(context.model, plan_options(*context.model, names), options);
  run_over_time(context, result, analysis, *grid, names,
                {.analysis = task.type(),
                 .timed = true,
                 .velocity = true,
                 .acceleration = true,
                 .multipliers = inverse_dynamics});
}

}  // namespace

void run_kinematics(AnalysisContext& context, AnalysisResult& result) { run(context, result, false); }
void run_inverse_dynamics(AnalysisContext& context, AnalysisResult& result) { run(context, result, true); }

}  // namespace catena
