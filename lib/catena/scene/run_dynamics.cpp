// dynamics: the motion that follows from forces.
#include "catena/analysis/dynamics_with_events.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {
namespace {

std::vector<Event> events_of(const AnalysisTask& task, const Model& model) {
  // In the order of the keys' words.
  constexpr EventDirection directions[] = {EventDirection::any, EventDirection::up, EventDirection::down};
  constexpr EventAction actions[] = {EventAction::record, EventAction::stop, EventAction::release, EventAction::engage};
  std::vector<Event> events;
  for (const EventRequest& request : task.events) {
    events.push_back({request.name, request.column, request.value, directions[request.direction],
                      actions[request.action], request.element.empty() ? -1 : model.find_element(request.element)});
  }
  return events;
}

void run_with_events(AnalysisContext& context, AnalysisResult& result, const TimeGrid& grid,
                     const DynamicsOptions& options, const std::vector<std::string>& names,
                     const ColumnSources& sources) {
  std::vector<std::string> reactions = names;
  for (const EventRequest& request : context.task.events) reactions.push_back(request.column);
  DynamicsWithEvents analysis(context.model, plan_options(*context.model, reactions), options,
                              events_of(context.task, *context.model), sources);
  run_over_time(context, result, analysis, grid, names, sources);
  std::vector<FieldRecord> records;
  for (const EventRecord& record : analysis.records())
    records.push_back({{"name", record.name}, {"t", record.t}, {"row", record.row}});
  result.fields.push_back({"method", std::string(to_string(analysis.method()))});
  result.fields.push_back({"events", std::move(records)});
}

}  // namespace

void run_dynamics(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  const std::optional<TimeGrid> grid = time_grid(context, result.report);
  if (!grid) return;
  DynamicsOptions options;
  options.method = static_cast<IntegrationMethod>(task.word("method"));  // in the order of the key's words
  options.tolerance = task.number("tolerance", options.tolerance);
  options.step = task.number("step", options.step);
  options.max_steps = static_cast<std::int64_t>(task.number("max_steps", static_cast<double>(options.max_steps)));
  const std::vector<std::string> names = task.output_names();
  const ColumnSources sources{.analysis = task.type(),
                              .timed = true,
                              .velocity = true,
                              .acceleration = true,
                              .multipliers = true,
                              .work = true};
  if (!task.events.empty()) return run_with_events(context, result, *grid, options, names, sources);
  Dynamics analysis(context.model, plan_options(*context.model, names), options);
  run_over_time(context, result, analysis, *grid, names, sources);
  result.fields.push_back({"method", std::string(to_string(analysis.method()))});
}

}  // namespace catena
