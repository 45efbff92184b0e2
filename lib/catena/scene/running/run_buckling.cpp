// buckling: values of a load parameter at which the current equilibrium loses its stability; one row a value, with the
// shape in which it does if outputs are named.
#include "catena/analysis/stability/buckling.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/drawn_shapes.hpp"
#include "catena/scene/running/shape_columns.hpp"

namespace catena {

void run_buckling(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  const int parameter = task.word("parameter");
  BucklingOptions options;
  options.present = task.parameters.at(static_cast<std::size_t>(parameter));
  options.count = static_cast<int>(task.number("count", 1));
  Buckling analysis(
      context.model, [&](double value) { return context.model_at(parameter, value); }, options);
  SystemState start = context.state;
  start.t = frozen_time(context);
  analysis.start_from(start);
  BucklingReport report = analysis.run([&] { return !(context.cancel && context.cancel->load()); });

  std::vector<ColumnInfo> info{{std::string(context.parameter_name), UnitKind::none}};
  std::optional<ShapeColumns> shapes;
  if (!task.outputs.empty()) {
    shapes.emplace(*context.model, analysis.plan(), task.output_names(), task.type());
    info.insert(info.end(), shapes->info().begin(), shapes->info().end());
    if (!shapes->note().empty()) report.warnings.push_back(shapes->note());
  }
  context.rows.begin(info);
  std::vector<double> row(info.size());
  std::int64_t rows = 0;
  for (std::size_t k = 0; k < report.loads.size(); ++k, ++rows) {
    row[0] = report.loads[k];
    if (shapes)
      shapes->evaluate(analysis.evaluator(), analysis.q(), report.shapes[k], std::span<double>(row).subspan(1));
    if (!context.rows.row(row)) break;
  }
  draw_shapes(context, analysis.evaluator(), start.t, analysis.q(), report.shapes);
  // Places alone change hands: velocities and time stay those of the motion so far.
  if (report.ok()) context.state.q = analysis.state().q;
  result.fields = {{"loads", report.loads}};
  take_report(result, std::move(report), nullptr, 0);
  result.has_rows = true;
  result.columns = std::move(info);
  result.rows = rows;
}

}  // namespace catena
