#include "catena/scene/running/analysis_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catena/analysis/events/engaged_turns.hpp"
#include "catena/analysis/events/engagement.hpp"
#include "catena/analysis/events/first_actions.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"
#include "catena/elements/all.hpp"
#include "catena/scene/judging/distance_check.hpp"

namespace catena {
namespace {

// In parameters that could be carried forward at the same cost: the way back by itself, over phases of contacts too,
// where both go in dual numbers; and what an integral adds, which has pulses inside of every step.
constexpr double dynamics_base = 2, phases_base = 5, dynamics_integral = 3;

struct Runner {
  std::string_view type;
  AnalysisFunction run;
};

constexpr Runner entries[] = {{"check", run_check},           {"assemble", run_assemble},
                              {"kinematics", run_kinematics}, {"inverse_dynamics", run_inverse_dynamics},
                              {"dynamics", run_dynamics},     {"equilibrium", run_equilibrium},
                              {"modes", run_modes},           {"path", run_path},
                              {"buckling", run_buckling},     {"sensitivity", run_sensitivity},
                              {"optimise", run_optimise},     {"sweep", run_sweep}};

/// Whether one way back for the measures costs less than to carry all parameters forward.
bool adjoint_is_cheaper(const AnalysisContext& context, bool has_phases) {
  const std::vector<PlacedMeasure>& measures = context.task.measures;
  const auto count = static_cast<double>(measures.size()),
             parameters = static_cast<double>(context.design->names.size());
  const auto is_integral = [](const PlacedMeasure& measure) {
    const MeasureKind kind = measure.request.kind;
    return kind == MeasureKind::integral || kind == MeasureKind::mean || kind == MeasureKind::rms;
  };
  const auto integrals = static_cast<double>(std::count_if(measures.begin(), measures.end(), is_integral));
  if (context.task.type() != "dynamics") return parameters > parameters_at_once * count;
  return parameters > (has_phases ? phases_base : dynamics_base) + count + dynamics_integral * integrals;
}

/// The model whose values of what events have engaged are moved by the whole turns that bodies had made without it
/// (engaged_turns.hpp), at the state where the analysis starts: springs and ropes may count these turns, and a rack
/// lies elsewhere after them.
std::shared_ptr<const Model> turned_to_bodies(std::shared_ptr<const Model> model, const AnalysisContext& context) {
  const SystemState& state = context.state;
  if (context.task.from_initial || state.held.empty() || state.q.empty() || !model) return model;
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*model, {.released_elements = state.released}), *model, work);
  evaluator.set_time(state.t);
  const std::vector<double> q = configuration_of(evaluator, state);
  std::shared_ptr<Model> turned;
  for (const int element : state.held) {
    const int turns = whole_turns_of(*model, element, residuals_of(evaluator, q, element));
    if (turns == 0) continue;
    if (!turned) turned = std::make_shared<Model>(*model);
    turn_value(*turned, element, turns);
  }
  return turned ? turned : model;
}

/// Whether a motion with events does that by itself, and tells checkpoints of it.
bool counts_turns_itself(std::string_view type) {
  return type == "dynamics" || type == "kinematics" || type == "inverse_dynamics";
}

Report refuse(std::string message) {
  Report report;
  report.status = Status::refused;
  report.message = std::move(message);
  return report;
}

/// The function that runs an analysis of this type; nullptr if none does.
AnalysisFunction analysis_function(std::string_view type) {
  for (const Runner& entry : entries) {
    if (entry.type == type) return entry.run;
  }
  return nullptr;
}

}  // namespace

void run_analysis(AnalysisContext& context, AnalysisResult& result) {
  const std::vector<int> before = context.task.from_initial ? std::vector<int>() : context.state.held;
  if (!counts_turns_itself(context.task.type())) context.model = turned_to_bodies(context.model, context);
  analysis_function(context.task.type())(context, result);
  // One that has others inside has run these, and each of them has done so.
  if (!context.task.of.empty()) return;
  std::vector<int>& held = context.state.held;
  held.insert(held.end(), before.begin(), before.end());
  held = held_by_events({}, context.state.released, held);
}

std::shared_ptr<const Model> model_at(const AnalysisContext& context, int parameter, double value) {
  ParameterSeeds seeds = context.seeds;  // the last one of a parameter counts
  seeds.push_back({parameter, value});
  return turned_to_bodies(context.models->model(*context.task.table, seeds), context);
}

DesignModels designs_of(const AnalysisContext& context, int last, std::optional<ParameterSeed<double>> at) {
  ParameterSeeds seeds = context.seeds;
  if (at) seeds.push_back(*at);
  std::vector<int> parameters = context.design->parameters;
  if (last >= 0) parameters.push_back(last);
  return context.models->designs(*context.task.table, seeds, parameters);
}

bool goes_back(AnalysisContext& context, std::string_view obstacle, bool has_phases) {
  if (!context.design || context.design->rows || context.design->mode == GradientMode::forward) return false;
  std::string why(obstacle);
  if (why.empty()) why = AdjointMechanism::why_not(*context.model, has_phases);
  if (!why.empty()) {
    context.forward_because = why;
    return false;
  }
  context.goes_back = context.design->mode == GradientMode::adjoint || adjoint_is_cheaper(context, has_phases);
  return context.goes_back;
}

std::string trouble_with_one_sided(const AnalysisContext& context, const SystemState& start) {
  const std::string type(context.task.type());
  if (context.design && !context.model->gaps().empty())
    return type + " with one-sided elements has no derivatives: they jump where one opens or closes";
  RopeWaysAt ways(context.model);
  if (!start.q.empty()) static_cast<void>(ways.begin(start));
  for (const RopeRoute& route : ways.routes()) {
    const bool beside = std::find(route.off.begin(), route.off.end(), 1) != route.off.end();
    if (!beside && ways.lie_as_given()) continue;
    return fmt::format(
        "rope \"{}\" {}: {} does not follow it over pulleys, and makes models at other values of the parameter in "
        "which "
        "it lies as given; equilibrium, dynamics and kinematics do",
        context.model->element_name(route.element),
        beside ? "lies beside a pulley" : "lies otherwise than in the given configuration", type);
  }
  return {};
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
  if (report = check_time_functions(*context.model, {first, last}); !report.ok()) return {};
  if (const auto problem = vanishing_distance(*context.model, context.state.t, *grid)) {
    report = refuse(*problem);
    return {};
  }
  return grid;
}

PlanOptions plan_options(const Model& model, const std::vector<std::string>& outputs, const SystemState& state) {
  return {.keep_elements = elements_with_reactions(model, outputs), .released_elements = state.released};
}

PlanOptions plan_without_gaps(const Model& model, const std::vector<std::string>& outputs, const SystemState& state) {
  PlanOptions options = plan_options(model, outputs, state);
  const std::vector<int> gaps = model.gaps();
  options.released_elements.insert(options.released_elements.end(), gaps.begin(), gaps.end());
  return options;
}

}  // namespace catena
