#include "catena/scene/designing/lane_motion_designs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <functional>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/energy.hpp"
#include "catena/scene/designing/no_rows.hpp"

namespace catena {
namespace {

bool finds_loads(const AnalysisTask& task) { return task.type() == "inverse_dynamics"; }

ColumnSources sources_of(const AnalysisTask& task) {
  return {.analysis = task.type(),
          .timed = true,
          .velocity = true,
          .acceleration = true,
          .multipliers = finds_loads(task),
          .work = finds_loads(task)};
}

PlanOptions options_of(const AnalysisTask& task, const Model& model) {
  PlanOptions options = plan_options(model, task.column_names());
  options.released_elements = model.gaps();
  return options;
}

/// Empty, or why the analysis cannot be computed in lanes.
std::string obstacle_of_motion(const AnalysisTask& task) {
  if (!task.events.empty()) return "its analysis has events";
  if (task.word("free") != 0) return "its analysis allows motions that nothing drives";
  for (const PlacedMeasure& measure : task.measures) {
    if (measure.request.kind == MeasureKind::field)
      return fmt::format("measure \"{}\" is of a field, not of a column", measure.request.name);
  }
  return {};
}

std::optional<LaneColumns> columns_of(const LaneProgram& program, const Model& model, const MeasureSet& measures) {
  if (measures.empty()) return {};
  std::vector<std::string> names;
  for (const ColumnInfo& column : measures.columns().info()) names.push_back(column.name);
  return LaneColumns::make(program, model, names);
}

}  // namespace

std::unique_ptr<LaneDesigns> LaneMotionDesigns::make(const AnalysisContext& context, std::string& why_not) {
  const AnalysisTask& inner = context.task.of.front();
  why_not = obstacle_of_motion(inner);
  if (!context.state.released.empty()) why_not = "an event of an analysis before has released a constraint";
  if (!why_not.empty()) return nullptr;
  std::shared_ptr<const Model> model = context.models->model(*inner.table, context.seeds, &why_not);
  if (!model) return nullptr;
  try {
    std::shared_ptr<const Plan> plan = Plan::make(*model, options_of(inner, *model));
    std::unique_ptr<const LaneProgram> program = LaneProgram::make(*model, plan, finds_loads(inner), why_not);
    if (!program) return nullptr;
    // Throws for columns that such an analysis does not give.
    auto measures =
        std::make_unique<MeasureSet>(inner.measure_requests(), *model, *plan, sources_of(inner), TimeRange{});
    if (!measures->empty() && measures->needs().work) {
      why_not = "some measure is of work, which is summed up along the motion";
      return nullptr;
    }
    return std::unique_ptr<LaneDesigns>(
        new LaneMotionDesigns(context, std::move(model), std::move(plan), std::move(program), std::move(measures)));
  } catch (const std::invalid_argument& error) {
    why_not = error.what();
    return nullptr;
  }
}

LaneMotionDesigns::LaneMotionDesigns(const AnalysisContext& context, std::shared_ptr<const Model> model,
                                     std::shared_ptr<const Plan> plan, std::unique_ptr<const LaneProgram> program,
                                     std::unique_ptr<MeasureSet> measures)
    : outer_(context),
      model_(std::move(model)),
      program_(std::move(program)),
      measures_(std::move(measures)),
      evaluator_(std::move(plan), *model_, evaluation_),
      motion_(*program_),
      look_(*program_, evaluator_, columns_of(*program_, *model_, *measures_)) {
  for (Lane& lane : lanes_) lane.task = context.task.of.front();
}

AnalysisContext LaneMotionDesigns::context_of(const Lane& lane) {
  static NoRows no_rows;
  return {.task = lane.task,
          .model = lane.model,
          .state = start_,
          .rows = no_rows,
          .progress = {},
          .models = outer_.models};
}

std::string LaneMotionDesigns::prepare(Lane& lane, const ParameterSeeds& seeds) {
  if (std::optional<std::string> why = outer_.models->set_parameters(lane.task, seeds)) return *why;
  std::string why;
  std::shared_ptr<const Model> model = outer_.models->model(*lane.task.table, seeds, &why);
  if (!model) return why;
  // The evaluator may still refer to it.
  const std::shared_ptr<const Model> before = std::exchange(lane.model, std::move(model));
  try {
    take_model(*lane.model);
  } catch (const std::invalid_argument&) {
    take_model(*model_);
    return "it has other bodies or elements than the scene";
  }
  if (finds_loads(lane.task) && body_without_mass(*lane.model, program_->plan()) >= 0) return "a body has no mass";
  lane.length_scale = evaluator_.length_scale();
  Report report;
  const std::optional<TimeGrid> grid = time_grid(context_of(lane), report);
  if (!grid) return report.message;
  lane.instants.clear();
  for (std::int64_t k = 0; k < grid->size(); ++k) lane.instants.push_back((*grid)[k]);
  const std::vector<double>& t = lane.instants;
  const bool ascend = std::adjacent_find(t.begin(), t.end(), std::greater_equal<>()) == t.end();
  if (!ascend || !(t.front() >= 0)) return "its instants are not in order, from zero on";
  return {};
}

// Squared distances are scaled by their values at the start.
void LaneMotionDesigns::take_model(const Model& model) {
  evaluator_.set_time(0);
  evaluator_.set_model(model);
  evaluator_.go_to_given_curve_places();
}

unsigned LaneMotionDesigns::assemble(unsigned lanes, std::span<Outcome> outcomes) {
  const auto& bodies = model_->bodies;
  const bool held =
      std::any_of(bodies.begin(), bodies.end(), [](const auto& b) { return b.hold_x || b.hold_y || b.hold_angle; });
  unsigned near = motion_.assemble({});
  if (held) near = 0;
  const unsigned far = lanes & ~near;
  if (far == 0) return lanes;
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(far & 1U << lane)) continue;
    take_model(*lanes_[at(lane)].model);
    std::vector<double> q = evaluator_.given_configuration();
    if (!Assembler(evaluator_).assemble(q).ok()) {
      outcomes[at(lane)].why_not = "it is not assembled by Newton's method alone";
      lanes &= ~(1U << lane);
      continue;
    }
    for (int b = 0; b < motion_.coordinates() / 3; ++b) {
      q[at(3 * b)] += evaluator_.origin(b).x;
      q[at(3 * b + 1)] += evaluator_.origin(b).y;
    }
    motion_.set_start(lane, q, evaluator_.curve_places());
  }
  near = motion_.assemble({});
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(lanes & ~near & 1U << lane)) continue;
    const char* const trouble = motion_.solver().trouble(lane);
    outcomes[at(lane)].why_not = trouble ? trouble : "its assembled configuration is near to a singular one";
  }
  return lanes & near;
}

void LaneMotionDesigns::measure(std::span<const ParameterSeeds> designs, std::span<Outcome> outcomes) {
  unsigned lanes = 0;
  int first = -1;
  for (int lane = 0; lane < static_cast<int>(designs.size()); ++lane) {
    Outcome& outcome = outcomes[at(lane)];
    outcome = {std::nullopt, prepare(lanes_[at(lane)], designs[at(lane)])};
    if (!outcome.why_not.empty()) continue;
    if (first < 0) first = lane;
    if (lanes_[at(lane)].instants.size() != lanes_[at(first)].instants.size()) {
      outcome.why_not = "it has another number of rows than the designs beside it";
      continue;
    }
    lanes |= 1U << lane;
  }
  if (lanes == 0) return;
  const auto design_of = [&](int lane) -> const Lane& { return lanes_[at(lanes & 1U << lane ? lane : first)]; };
  for (int lane = 0; lane < lane_count; ++lane)
    motion_.set_design(lane, *design_of(lane).model, design_of(lane).length_scale);
  lanes = assemble(lanes, outcomes);
  if (lanes == 0) return;
  motion_.run(lanes, static_cast<int>(lanes_[at(first)].instants.size()),
              [&](int row, int lane) { return design_of(lane).instants[at(row)]; });
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(lanes & 1U << lane)) continue;
    if (motion_.alive() & 1U << lane)
      take_measures(lane, outcomes[at(lane)]);
    else
      outcomes[at(lane)].why_not = motion_.why(lane);
  }
}

bool LaneMotionDesigns::follow_rows(const std::vector<double>& instants) {
  // As AnalysisRows does.
  double covered_to = 0;
  for (const double t : instants) {
    if (t > covered_to && (t - covered_to >= measures_->pace() || t == instants.back())) {
      measures_->cover({covered_to, t, [&](double instant) { return look_.at(instant); },
                        [&](std::span<const double> next) { look_.expect(next); }});
      covered_to = t;
    }
    if (look_.lost()) return false;
    if (look_.has_columns()) {
      measures_->take_row(t);
    } else if (const std::optional<Snapshot> row = look_.at(t)) {
      measures_->take_row(*row, false);
    }
    if (look_.lost()) return false;
  }
  return true;
}

void LaneMotionDesigns::take_measures(int lane, Outcome& outcome) {
  const Lane& design = lanes_[at(lane)];
  take_model(*design.model);
  look_.follow(motion_, lane, *design.model, design.instants);
  measures_->begin_again(design.task.measure_requests(), *design.model, {0, design.instants.back()});
  if (look_.has_columns())
    measures_->use_values([this](double t, std::span<double> out) { return look_.values(t, out); });
  if (!follow_rows(design.instants)) {
    outcome.why_not = "its motion between rows is too rough for lanes";
    return;
  }
  std::vector<double> values;
  for (const MeasureResult& result : measures_->results()) {
    if (!result.value) {
      outcome.why_not = fmt::format("measure \"{}\": {}", result.name, result.trouble);
      return;
    }
    values.push_back(*result.value);
  }
  outcome.measures = std::move(values);
}

}  // namespace catena
