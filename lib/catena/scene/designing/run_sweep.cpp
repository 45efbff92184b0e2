// sweep: analyses repeated over values of parameters; one row a design, whatever the number of threads and processes.
#include <fmt/format.h>

#include <cstdio>

#include "catena/columns/column_names.hpp"
#include "catena/scene/designing/sweep.hpp"

namespace catena {
namespace {

/// What a sweep that was stopped says.
std::string stopped_text(const AnalysisContext& context, std::int64_t rows, const Sweep& sweep) {
  std::string text = fmt::format("stopped after {} of {} designs; their rows are kept", rows, sweep.designs());
  if (const std::string missing = sweep.describe_missing(); !missing.empty())
    text += fmt::format(". Designs without rows: {}", missing);
  if (const SweepRecord* record = context.sweep.record)
    text +=
        fmt::format(". The record \"{}\" has {} designs: --resume goes on from them", record->path(), record->size());
  return text;
}

/// The column of a measure: its unit is that of the column it is taken of, times s of an integral.
ColumnInfo column_of(const MeasureRequest& measure, const Model& model) {
  ColumnInfo info{measure.name, UnitKind::own};
  std::vector<NamedColumn> named;
  if (measure.columns.empty() || find_columns(model, measure.columns.front(), named) || named.size() != 1) return info;
  info.own_unit = named.front().info.unit_text();
  if (measure.kind == MeasureKind::integral && !info.own_unit.empty())
    info.own_unit = info.own_unit == "1" ? "s" : info.own_unit + " s";
  return info;
}

}  // namespace

void run_sweep(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  std::vector<ColumnInfo> info{{"design", UnitKind::none}};
  Sweep sweep(context);
  for (std::string& name : sweep.parameters()) info.push_back({std::move(name), UnitKind::own});
  for (const AnalysisTask& inner : task.of) {
    for (const PlacedMeasure& measure : inner.measures) info.push_back(column_of(measure.request, *context.model));
  }
  info.push_back({"status", UnitKind::none});
  info.back().is_status = true;
  if (!sweep.follows()) context.rows.begin(info);
  const std::int64_t rows = sweep.run(context.threads);
  if (context.verbose && !context.sweep.link) fmt::print(stderr, "sweep: {}\n", sweep.describe_lanes());
  if (sweep.stopped()) {
    result.report.status = Status::cancelled;
    result.report.message = stopped_text(context, rows, sweep);
  }
  if (sweep.follows()) return;
  for (const std::string& trouble : sweep.troubles()) result.report.warnings.push_back(trouble);
  FieldRecord failed;
  std::int64_t failures = 0;
  for (const auto& [status, count] : sweep.failed()) {
    failed.emplace_back(status, count);
    failures += count;
  }
  if (failures > 0)
    result.report.warnings.push_back(
        fmt::format("{} of {} designs could not be analysed: \"failures\" has their reasons", failures, rows));
  result.has_rows = true;
  result.columns = std::move(info);
  result.rows = rows;
  result.fields.push_back({"designs", rows});
  result.fields.push_back({"failed", std::move(failed)});
  // What other processes had in lanes is not known.
  if (!context.sweep.link) result.fields.push_back({"in_lanes", sweep.in_lanes()});
  result.fields.push_back({"failures", sweep.failures()});
  if (sweep.scatter() && !sweep.stopped())
    result.fields.push_back({"scatter", sweep.scatter()->records(context, result.report.warnings)});
}

}  // namespace catena
