// modes: small oscillations about the current configuration; one row a mode.
#include "catena/analysis/stability/modes.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/drawn_shapes.hpp"
#include "catena/scene/running/shape_columns.hpp"

namespace catena {

void run_modes(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  ModesOptions options;
  options.count = static_cast<int>(task.number("count", 0));
  Modes analysis(context.model, {}, options);
  SystemState start = context.state;
  start.t = frozen_time(context);
  analysis.start_from(start);
  ModesReport report = analysis.run([&] { return !(context.cancel && context.cancel->load()); });

  std::vector<ColumnInfo> info{
      {"mode", UnitKind::none}, {"omega2", UnitKind::squared_frequency}, {"omega", UnitKind::angular_velocity}};
  std::optional<ShapeColumns> shapes;
  if (task.number("shapes", 0) != 0) {
    shapes.emplace(*context.model, analysis.plan(), task.output_names(), task.type());
    info.insert(info.end(), shapes->info().begin(), shapes->info().end());
    if (!shapes->note().empty()) report.warnings.push_back(shapes->note());
  }
  context.rows.begin(info);
  std::vector<double> row(info.size());
  analysis.evaluator().set_configuration(analysis.q());
  std::int64_t rows = 0;
  for (std::size_t k = 0; k < report.omega2.size(); ++k, ++rows) {
    row[0] = static_cast<double>(k + 1);
    row[1] = report.omega2[k];
    row[2] = report.omega[k];
    if (shapes)
      shapes->evaluate(analysis.evaluator(), analysis.q(), report.shapes[k], std::span<double>(row).subspan(3));
    if (!context.rows.row(row)) break;
  }
  draw_shapes(context, analysis.evaluator(), start.t, analysis.q(), report.shapes);
  // Places alone change hands, if they had to be assembled: velocities and time stay those of the motion so far.
  if (report.ok()) context.state.q = analysis.state().q;
  result.fields = {
      {"omega2", report.omega2}, {"omega", report.omega}, {"unstable", static_cast<std::int64_t>(report.unstable)}};
  if (report.free_motions > 0) {
    result.fields.push_back({"free_motions", static_cast<std::int64_t>(report.free_motions)});
    result.fields.push_back({"moving_freely", report.free_bodies});
  }
  take_report(result, std::move(report), nullptr, 0);
  result.has_rows = true;
  result.columns = std::move(info);
  result.rows = rows;
}

}  // namespace catena
