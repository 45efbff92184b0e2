// path: static equilibria as a parameter changes; one row a point, the parameter first.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "catena/analysis/accuracy/path_accuracy.hpp"
#include "catena/analysis/measures/measure_set.hpp"
#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/run/weightless_bodies.hpp"
#include "catena/analysis/sensitivity/spectrum/spectrum_derivatives.hpp"
#include "catena/analysis/stability/path.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {
namespace {

/// A row of the path, kept for derivatives.
struct PathPlace {
  double value;
  std::vector<double> q, lambda;
};

std::vector<double> to_vector(std::span<const double> values) { return {values.begin(), values.end()}; }

/// Of the value of the path's parameter at a critical point; not numbers, and why, where there is none.
std::vector<double> critical_gradient(const AnalysisContext& context, const std::shared_ptr<const Plan>& plan,
                                      const PathPlace& place, double t, std::string& trouble) {
  const int parameter = context.task.word("parameter");
  const std::size_t count = context.design->names.size();
  std::vector<double> none(count, std::numeric_limits<double>::quiet_NaN());
  const std::shared_ptr<const Model> model = model_at(context, parameter, place.value);
  if (!model) {
    trouble = "the scene allows no model at this value";
    return none;
  }
  EvaluationWork work;
  const Evaluator evaluator(plan, *model, work);
  const DesignModels models = designs_of(context, parameter, ParameterSeed<double>{parameter, place.value});
  const auto gradient =
      limit_load_gradient(evaluator, models, static_cast<int>(count) + 1, {t, place.q, place.lambda}, trouble);
  return gradient ? *gradient : none;
}

void add_column_measures(const AnalysisContext& context, const MeasureSet& measures, AnalysisResult& result) {
  for (MeasureResult& measure : measures.results()) {
    measure.t.reset();
    if (context.design) {
      measure.gradient.assign(context.design->names.size(), std::numeric_limits<double>::quiet_NaN());
      if (measure.trouble.empty())
        measure.trouble = "columns along a path have no derivatives: measure an equilibrium, or a critical value";
    }
    if (!measure.trouble.empty())
      result.report.warnings.push_back(fmt::format("measure \"{}\": {}", measure.name, measure.trouble));
    result.measures.push_back(std::move(measure));
  }
}

PathOptions path_options_of(const AnalysisTask& task) {
  PathOptions options;
  options.from = task.parameters.at(static_cast<std::size_t>(task.word("parameter")));
  options.to = task.number("to", 0);
  options.max_steps = static_cast<int>(task.number("max_steps", options.max_steps));
  options.arc = task.number("arc", options.arc);
  options.branch = static_cast<int>(task.number("branch", 0));
  return options;
}

std::vector<NamedField> fields_of(const PathReport& report, const Model& model, bool one_sided) {
  std::vector<FieldRecord> critical;
  for (const PathCritical& point : report.critical) {
    critical.push_back({{"kind", std::string(point.flutter  ? "flutter"
                                             : point.branch ? "branch"
                                                            : "limit")},
                        {"value", point.value},
                        {"row", static_cast<std::int64_t>(point.row)},
                        {"mode", point.mode},
                        {"modes", static_cast<std::int64_t>(point.modes)}});
    if (point.flutter) critical.back().push_back({"omega", point.omega});
  }
  std::vector<NamedField> fields{{"critical", std::move(critical)},
                                 {"negative_modes", report.negative_modes},
                                 {"steps", static_cast<std::int64_t>(report.steps)}};
  if (!report.flutter.empty()) fields.push_back({"flutter", report.flutter});
  if (!one_sided) return fields;
  std::vector<FieldRecord> changes;
  for (const PathChange& change : report.changes) {
    changes.push_back({{"element", model.element_name(change.element)},
                       {"kind", std::string(change.closes ? "closes" : "opens")},
                       {"value", change.value},
                       {"row", static_cast<std::int64_t>(change.row)}});
  }
  fields.push_back({"active", report.active});
  fields.push_back({"changes", std::move(changes)});
  return fields;
}

/// Of the parameter's values at the critical points.
void differentiate(const AnalysisContext& context, Path& analysis, const PathReport& report,
                   const std::vector<PathPlace>& places, double t, AnalysisResult& result) {
  const bool conservative = analysis.evaluator().conservative();
  for (std::size_t k = 0; k < report.critical.size(); ++k) {
    std::string trouble;
    std::vector<double> gradient(context.design->names.size(), std::numeric_limits<double>::quiet_NaN());
    if (conservative) {
      gradient = critical_gradient(context, analysis.evaluator().shared_plan(),
                                   places[static_cast<std::size_t>(report.critical[k].row)], t, trouble);
    } else {
      trouble = forces_without_energy(*context.model) + ": derivatives of critical values are not built";
    }
    set_field_gradient(context, result, "critical", static_cast<int>(k) + 1, gradient, trouble);
  }
}

}  // namespace

void run_path(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  const int parameter = task.word("parameter");
  const PathOptions options = path_options_of(task);
  if (options.branch > 3) {
    return refuse(result, "\"branch\" of a path is 1 (straight on), 2 or 3 (to either side at the first branch point)");
  }
  SystemState start = context.state;
  start.t = frozen_time(context);
  if (const std::string why = trouble_with_one_sided(context, start); !why.empty()) return refuse(result, why);
  const ModelAt models = [&](double value) { return model_at(context, parameter, value); };
  Path analysis(context.model, models, options, plan_options(*context.model, task.column_names(), context.state));
  const ColumnSources sources{.analysis = task.type(), .multipliers = true};
  const ColumnSet columns = ColumnSet::resolve(*context.model, analysis.plan(), task.output_names(), sources);
  analysis.start_from(start);

  std::vector<ColumnInfo> info{{std::string(context.parameter_name), UnitKind::own}};
  info.insert(info.end(), columns.info().begin(), columns.info().end());
  context.rows.begin(info);
  std::vector<double> row(info.size());
  std::int64_t rows = 0;
  MeasureSet measures(task.measure_requests(), *context.model, analysis.plan(), sources, {start.t, start.t});
  std::vector<PathPlace> places;
  std::optional<PathAccuracy> accuracy;
  if (context.digits && !context.design) accuracy.emplace(analysis, context.model, models, options, start.t, columns);
  PathReport report = analysis.run([&](double value, const Snapshot& snapshot) {
    measures.take_row(snapshot, true);
    if (context.design) places.push_back({value, to_vector(snapshot.q), to_vector(snapshot.lambda)});
    row[0] = value;
    columns.evaluate(snapshot, std::span<double>(row).subspan(1));
    if (accuracy) accuracy->take(value, snapshot, row);
    if (context.poses) context.poses->pose(snapshot);
    ++rows;
    if (context.progress) context.progress(std::clamp((value - options.from) / (options.to - options.from), 0.0, 1.0));
    return context.rows.row(row) && !(context.cancel && context.cancel->load(std::memory_order_relaxed));
  });
  context.state = analysis.state();
  if (report.ok()) context.state.ropes = RopeWaysAt(context.model).turns(context.state);
  if (report.ok() && rows > 0) context.values_at_end = {{parameter, row[0]}};
  result.fields = fields_of(report, *context.model, !analysis.plan().gap_rows.empty());
  result.report = report;
  if (std::string remark = remark_on_weightless(*context.model, analysis.plan()); !remark.empty())
    result.report.warnings.push_back(std::move(remark));
  if (accuracy) result.digits = accuracy->digits(report);
  for (const std::string& note : columns.notes()) result.report.warnings.push_back(note);
  take_rows(result, std::move(info), rows);
  add_column_measures(context, measures, result);
  add_field_measures(context, result);
  if (context.design) differentiate(context, analysis, report, places, start.t, result);
}

}  // namespace catena
