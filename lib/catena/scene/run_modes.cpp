// modes: small oscillations about the current configuration; one row a mode.
#include <algorithm>
#include <map>

#include "catena/analysis/modes.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {
namespace {

/// The column whose value is the rate of change of another: its share in a motion is the other's in a shape.
const std::map<ColumnKind, ColumnKind>& rates() {
  static const std::map<ColumnKind, ColumnKind> all{{ColumnKind::x, ColumnKind::vx},
                                                    {ColumnKind::y, ColumnKind::vy},
                                                    {ColumnKind::angle, ColumnKind::omega},
                                                    {ColumnKind::value, ColumnKind::rate},
                                                    {ColumnKind::joint_angle, ColumnKind::joint_omega},
                                                    {ColumnKind::slide, ColumnKind::slide_rate},
                                                    {ColumnKind::length, ColumnKind::length_rate}};
  return all;
}

/// What a shape shows: the columns asked for whose rates are columns too.
struct ShapeColumns {
  std::vector<ColumnInfo> info;
  std::vector<std::string> rate_names;
  std::string first_left_out;
  int left_out = 0;
};

/// The name of the column that shows the rate of `column`: that with the ending of its kind.
std::string rate_name(const NamedColumn& column, const Model& model) {
  const auto rate = rates().find(column.column.kind);
  if (rate == rates().end()) return {};
  static const std::map<ColumnKind, std::string_view> endings{{ColumnKind::vx, "vx"},
                                                              {ColumnKind::vy, "vy"},
                                                              {ColumnKind::omega, "omega"},
                                                              {ColumnKind::rate, "rate"},
                                                              {ColumnKind::joint_omega, "omega"},
                                                              {ColumnKind::slide_rate, "slide_rate"},
                                                              {ColumnKind::length_rate, "rate"}};
  const std::string& name = column.info.name;
  const std::string named = name.substr(0, name.rfind('.') + 1) + std::string(endings.at(rate->second));
  std::vector<NamedColumn> found;
  return find_columns(model, named, found) ? std::string() : named;
}

ShapeColumns shape_columns(const Model& model, const std::vector<std::string>& outputs) {
  ShapeColumns columns;
  std::vector<NamedColumn> named;
  if (outputs.empty()) named = default_columns(model);
  for (const std::string& name : outputs) find_columns(model, name, named);
  for (NamedColumn& column : named) {
    std::string rate = rate_name(column, model);
    if (std::find(columns.rate_names.begin(), columns.rate_names.end(), rate) != columns.rate_names.end()) continue;
    if (rate.empty()) {
      if (columns.left_out++ == 0) columns.first_left_out = column.info.name;
      continue;
    }
    columns.rate_names.push_back(std::move(rate));
    columns.info.push_back(std::move(column.info));
  }
  return columns;
}

}  // namespace

void run_modes(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  ModesOptions options;
  options.count = static_cast<int>(task.number("count", 0));
  const bool with_shapes = task.number("shapes", 0) != 0;
  Modes analysis(context.model, {}, options);
  SystemState start = context.state;
  start.t = frozen_time(context);
  analysis.start_from(start);
  ModesReport report = analysis.run([&] { return !(context.cancel && context.cancel->load()); });

  std::vector<ColumnInfo> info{
      {"mode", UnitKind::none}, {"omega2", UnitKind::angular_acceleration}, {"omega", UnitKind::angular_velocity}};
  ShapeColumns shapes;
  std::optional<ColumnSet> columns;
  if (with_shapes) {
    shapes = shape_columns(*context.model, task.output_names());
    info.insert(info.end(), shapes.info.begin(), shapes.info.end());
    if (shapes.left_out > 0) {
      report.warnings.push_back("left out " + shapes.first_left_out +
                                (shapes.left_out > 1 ? " and " + std::to_string(shapes.left_out - 1) + " more" : "") +
                                ": shapes show positions, angles and lengths only");
    }
    // Without names the default columns would come.
    if (!shapes.rate_names.empty())
      columns = ColumnSet::resolve(*context.model, analysis.plan(), shapes.rate_names,
                                   {.analysis = task.type(), .velocity = true});
  }
  context.rows.begin(info);
  const Plan& plan = analysis.plan();
  std::vector<double> row(info.size()), qd(static_cast<std::size_t>(plan.coordinates()), 0.0);
  analysis.evaluator().set_configuration(analysis.q());
  std::int64_t rows = 0;
  for (std::size_t k = 0; k < report.omega2.size(); ++k, ++rows) {
    row[0] = static_cast<double>(k + 1);
    row[1] = report.omega2[k];
    row[2] = report.omega[k];
    if (columns) {
      for (int c = 0; c < plan.columns; ++c)
        qd[static_cast<std::size_t>(plan.coordinate[static_cast<std::size_t>(c)])] =
            report.shapes[k][static_cast<std::size_t>(c)];
      columns->evaluate({.evaluator = analysis.evaluator(), .t = analysis.time(), .q = analysis.q(), .qd = qd},
                        std::span<double>(row).subspan(3));
    }
    if (!context.rows.row(row)) break;
  }
  if (report.ok()) context.state = analysis.state();
  result.fields = {
      {"omega2", report.omega2}, {"omega", report.omega}, {"unstable", static_cast<std::int64_t>(report.unstable)}};
  take_report(result, std::move(report), nullptr, 0);
  result.has_rows = true;
  result.columns = std::move(info);
  result.rows = rows;
}

}  // namespace catena
