// equilibrium: the configuration at rest, certified.
#include <fmt/format.h>

#include "catena/analysis/equilibrium.hpp"
#include "catena/analysis/static_ipopt.hpp"
#include "catena/analysis/static_nlopt.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {

void run_equilibrium(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  // In the order of the keys' words.
  constexpr StaticSolver solvers[] = {StaticSolver::automatic, StaticSolver::newton, StaticSolver::ipopt,
                                      StaticSolver::nlopt};
  EquilibriumOptions options;
  options.solver = solvers[task.word("solver")];
  const bool built_in = options.solver == StaticSolver::ipopt   ? ipopt_is_built_in()
                        : options.solver == StaticSolver::nlopt ? nlopt_is_built_in()
                                                                : true;
  if (!built_in) {
    const std::string name = options.solver == StaticSolver::ipopt ? "Ipopt" : "NLopt";
    return refuse(result, fmt::format("this catena was built without {} (CATENA_WITH_{}=OFF); leave \"solver\" out, or "
                                      "take \"newton\"",
                                      name, name == "Ipopt" ? "IPOPT" : "NLOPT"));
  }
  options.verbose = context.verbose;
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
  if (options.solver == StaticSolver::nlopt && analysis.plan().columns > StaticNloptOptions::most_columns) {
    return refuse(result,
                  fmt::format("the solver nlopt is dense and made for at most {} coordinates; this scene has {}",
                              StaticNloptOptions::most_columns, analysis.plan().columns));
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
