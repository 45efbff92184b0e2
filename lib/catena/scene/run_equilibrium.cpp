// equilibrium: the configuration at rest, certified.
#include "catena/analysis/equilibrium.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {

void run_equilibrium(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  // In the order of the keys' words.
  constexpr StaticSolver solvers[] = {StaticSolver::automatic, StaticSolver::newton, StaticSolver::ipopt,
                                      StaticSolver::nlopt};
  EquilibriumOptions options;
  options.solver = solvers[task.word("solver")];
  if (options.solver == StaticSolver::ipopt || options.solver == StaticSolver::nlopt) {
    return refuse(result, "the solvers ipopt and nlopt are not built yet; leave \"solver\" out");
  }
  if (task.number("find", 1) > 1) {
    return refuse(result, "looking for several equilibria is not built yet; leave \"find\" out");
  }
  options.tolerance = task.number("tolerance", options.tolerance);
  options.accept = task.word("accept") == 0 ? Accept::stable : Accept::stationary;
  const std::vector<std::string> names = task.output_names();
  Equilibrium analysis(context.model, plan_options(*context.model, names), options);
  if (!analysis.evaluator().conservative()) {
    return refuse(result,
                  "follower forces have no energy, and the equilibrium of forces without one is not built yet; give "
                  "the forces in ground axes");
  }
  const ColumnSet columns =
      ColumnSet::resolve(*context.model, analysis.plan(), names, {.analysis = task.type(), .multipliers = true});
  SystemState start = context.state;
  start.t = frozen_time(context);
  analysis.start_from(start);
  ReportingRows rows(columns, context, start.t);
  const EquilibriumReport report = analysis.run(TimeGrid::instant(start.t), columns.needs(), rows);
  context.state = analysis.state();
  if (report.certified) {
    result.fields = {{"energy", report.energy},
                     {"stable", report.stable},
                     {"negative_modes", static_cast<std::int64_t>(report.negative_modes)},
                     {"residual", report.residual},
                     {"solver", report.solver},
                     {"iterations", static_cast<std::int64_t>(report.iterations)}};
  }
  take_report(result, report, &columns, rows.rows());
}

}  // namespace catena
