#include "catena/scene/analysis_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catena/elements/all.hpp"
#include "catena/scene/distance_check.hpp"

namespace catena {
namespace {

struct Runner {
  std::string_view type;
  AnalysisFunction run;
};

constexpr Runner entries[] = {{"check", run_check},           {"assemble", run_assemble},
                              {"kinematics", run_kinematics}, {"inverse_dynamics", run_inverse_dynamics},
                              {"dynamics", run_dynamics},     {"equilibrium", run_equilibrium},
                              {"modes", run_modes},           {"path", run_path},
                              {"buckling", run_buckling}};

/// The element that reads the model's function of time number `function`.
std::string reader_of(const Model& model, int function) {
  std::string name;
  const auto look = [&](const auto& list, int) {
    for (const auto& entry : list) {
      for (const auto& value : entry.values) {
        if (value.function == function) name = model.element_name(entry.id);
      }
    }
  };
  for_each_list(model.constraints, look);
  for_each_list(model.forces, look);
  return name;
}

Report refuse(std::string message) {
  Report report;
  report.status = Status::refused;
  report.message = std::move(message);
  return report;
}

/// Whether all functions of time are defined from `first` to `last`.
bool check_tables(const Model& model, double first, double last, Report& report) {
  for (std::size_t k = 0; k < model.functions.size(); ++k) {
    const TimeRange range = model.functions[k].domain();
    // Times are multiples of a step and carry its rounding.
    const double slack = 1e-12 * std::max(std::abs(range.first), std::abs(range.last));
    if (first >= range.first - slack && last <= range.last + slack) continue;
    report = refuse(fmt::format(
        "the table of \"{}\" reaches from {} to {} s, but the analysis goes from {} to {} s; shorten the analysis, or "
        "make the table longer or periodic",
        reader_of(model, static_cast<int>(k)), range.first, range.last, first, last));
    return false;
  }
  return true;
}

}  // namespace

AnalysisFunction analysis_function(std::string_view type) {
  for (const Runner& entry : entries) {
    if (entry.type == type) return entry.run;
  }
  return nullptr;
}

double frozen_time(const AnalysisContext& context) {
  return context.task.at ? context.task.at->front() : context.state.t;
}

std::optional<TimeGrid> time_grid(const AnalysisContext& context, Report& report) {
  const AnalysisTask& task = context.task;
  double first = context.state.t, last = first;
  std::optional<TimeGrid> grid;
  if (task.at) {
    for (const double t : *task.at) {
      first = std::min(first, t);
      last = std::max(last, t);
    }
    grid = TimeGrid::list(*task.at);
  } else if (task.has("until")) {
    const double until = task.number("until", 0);
    if (until <= context.state.t) {
      report =
          refuse(fmt::format("\"until\" is {} s, but the analysis starts at {} s, where the one before ended; "
                             "\"from\": \"initial\" starts "
                             "at 0",
                             until, context.state.t));
      return {};
    }
    last = until;
    grid = TimeGrid::range(context.state.t, until, task.number("every", until / 100));
  } else {
    grid = TimeGrid::instant(context.state.t);
  }
  if (!check_tables(*context.model, first, last, report)) return {};
  if (const auto problem = vanishing_distance(*context.model, context.state.t, *grid)) {
    report = refuse(*problem);
    return {};
  }
  return grid;
}

PlanOptions plan_options(const Model& model, const std::vector<std::string>& outputs) {
  return {elements_with_reactions(model, outputs)};
}

void take_report(AnalysisResult& result, AnalysisReport report, const ColumnSet* columns, std::int64_t rows) {
  result.report = std::move(report);
  if (!columns) return;
  result.has_rows = true;
  result.columns.assign(columns->info().begin(), columns->info().end());
  result.rows = rows;
  for (const std::string& note : columns->notes()) result.report.warnings.push_back(note);
}

}  // namespace catena
