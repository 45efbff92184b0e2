// path: static equilibria as a parameter changes; one row a point, the parameter first.
#include <algorithm>

#include "catena/analysis/stability/path.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {

void run_path(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  const int parameter = task.word("parameter");
  PathOptions options;
  options.from = task.parameters.at(static_cast<std::size_t>(parameter));
  options.to = task.number("to", 0);
  options.max_steps = static_cast<int>(task.number("max_steps", options.max_steps));
  options.arc = task.number("arc", options.arc);
  options.branch = static_cast<int>(task.number("branch", 0));
  if (options.branch > 3) {
    return refuse(result, "\"branch\" of a path is 1 (straight on), 2 or 3 (to either side at the first branch point)");
  }
  const std::vector<std::string> names = task.output_names();
  Path analysis(
      context.model, [&](double value) { return context.model_at(parameter, value); }, options,
      plan_options(*context.model, names));
  const ColumnSet columns =
      ColumnSet::resolve(*context.model, analysis.plan(), names, {.analysis = task.type(), .multipliers = true});
  SystemState start = context.state;
  start.t = frozen_time(context);
  analysis.start_from(start);

  std::vector<ColumnInfo> info{{std::string(context.parameter_name), UnitKind::none}};
  info.insert(info.end(), columns.info().begin(), columns.info().end());
  context.rows.begin(info);
  std::vector<double> row(info.size());
  std::int64_t rows = 0;
  PathReport report = analysis.run([&](double value, const Snapshot& snapshot) {
    row[0] = value;
    context.parameter_at_end = value;
    columns.evaluate(snapshot, std::span<double>(row).subspan(1));
    if (context.poses) context.poses->pose(snapshot);
    ++rows;
    if (context.progress) context.progress(std::clamp((value - options.from) / (options.to - options.from), 0.0, 1.0));
    return context.rows.row(row) && !(context.cancel && context.cancel->load(std::memory_order_relaxed));
  });
  context.state = analysis.state();
  std::vector<FieldRecord> critical;
  for (const PathCritical& point : report.critical) {
    critical.push_back({{"kind", std::string(point.branch ? "branch" : "limit")},
                        {"value", point.value},
                        {"row", static_cast<std::int64_t>(point.row)},
                        {"mode", point.mode},
                        {"modes", static_cast<std::int64_t>(point.modes)}});
  }
  result.fields = {{"critical", std::move(critical)},
                   {"negative_modes", report.negative_modes},
                   {"steps", static_cast<std::int64_t>(report.steps)}};
  take_report(result, std::move(report), &columns, rows);
  result.columns = std::move(info);
}

}  // namespace catena
