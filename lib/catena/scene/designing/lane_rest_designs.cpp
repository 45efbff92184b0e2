#include "catena/scene/designing/lane_rest_designs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/balance/static_holding.hpp"
#include "catena/analysis/balance/static_turns.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/pose/whole_turns.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

/// Empty, or why the analysis cannot be computed in lanes.
std::string obstacle_of_rest(const AnalysisTask& task) {
  if (task.word("friction") != 0) return "it asks what friction holds";
  // In the order of the key's words: automatic, newton, ipopt, nlopt.
  if (task.word("solver") > 1) return "its solver is a library's";
  if (task.word("accept") != 0) return "it accepts equilibria that are not stable";
  if (task.number("find", 1) > 1) return "it looks for more than one equilibrium";
  for (const PlacedMeasure& measure : task.measures) {
    if (measure.request.kind == MeasureKind::field && measure.request.field != "energy")
      return fmt::format("measure \"{}\" is of the field {}, which lanes do not give", measure.request.name,
                         measure.request.field);
  }
  return {};
}

/// Empty, or why nothing holds the model.
std::string why_loose(std::shared_ptr<const Plan> plan, const Model& model) {
  EvaluationWork work;
  Evaluator evaluator(std::move(plan), model, work);
  StaticSystem system(evaluator);
  system.move_to(evaluator.given_configuration());
  const std::optional<Report> loose = find_loose_bodies(system, evaluator);
  return loose ? loose->message : std::string();
}

/// Whether whole turns between two configurations are one more or less by rounding.
bool is_half_a_turn_off(const Plan& plan, std::span<const double> start, std::span<const double> q) {
  constexpr double turn = 2 * std::numbers::pi, doubtful = 1e-9;
  bool is_off = false;
  for (int b = 0; b < plan.moving; ++b) {
    const double turns = (q[at(3 * b + 2)] - start[at(3 * b + 2)]) / turn;
    is_off = is_off || std::abs(turns - std::floor(turns) - 0.5) <= doubtful;
  }
  return is_off;
}

}  // namespace

std::unique_ptr<LaneDesigns> LaneRestDesigns::make(const AnalysisContext& context, std::string& why_not) {
  const AnalysisTask& inner = context.task.of.front();
  why_not = obstacle_of_rest(inner);
  if (!context.state.released.empty()) why_not = "an event of an analysis before has released a constraint";
  if (!why_not.empty()) return nullptr;
  std::shared_ptr<const Model> model = context.models->model(*inner.table, context.seeds, &why_not);
  if (!model) return nullptr;
  try {
    std::shared_ptr<const Plan> plan = Plan::make(*model, with_gaps(plan_options(*model, inner.column_names())));
    std::unique_ptr<const LaneProgram> program = LaneProgram::make_static(*model, plan, why_not);
    if (!program) return nullptr;
    why_not = why_loose(plan, *model);
    if (!why_not.empty()) return nullptr;
    const ColumnSources sources{.analysis = inner.type(), .multipliers = true};
    // Throws for columns that such an analysis does not give.
    auto measures = std::make_unique<MeasureSet>(inner.measure_requests(), *model, *plan, sources, TimeRange{});
    return std::unique_ptr<LaneDesigns>(
        new LaneRestDesigns(context, std::move(model), std::move(plan), std::move(program), std::move(measures)));
  } catch (const std::invalid_argument& error) {
    why_not = error.what();
    return nullptr;
  }
}

LaneRestDesigns::LaneRestDesigns(const AnalysisContext& context, std::shared_ptr<const Model> model,
                                 std::shared_ptr<const Plan> plan, std::unique_ptr<const LaneProgram> program,
                                 std::unique_ptr<MeasureSet> measures)
    : outer_(context),
      model_(std::move(model)),
      plan_(std::move(plan)),
      program_(std::move(program)),
      measures_(std::move(measures)),
      matrix_(plan_, std::vector<double>(at(plan_->moving), 1.0)),
      search_(*program_),
      tolerance_(context.task.of.front().number("tolerance", EquilibriumOptions{}.tolerance)),
      lambda_(at(plan_->rows)) {
  for (Lane& lane : lanes_) {
    lane.task = context.task.of.front();
    lane.evaluator.emplace(plan_, *model_, lane.work);
  }
  is_linear_ = plan_->constant_jacobian || matrix_.constraints_are_linear(*lanes_[0].evaluator);
}

std::string LaneRestDesigns::prepare(int number, const ParameterSeeds& seeds) {
  Lane& lane = lanes_[at(number)];
  if (std::optional<std::string> why = outer_.models->set_parameters(lane.task, seeds)) return *why;
  std::string why;
  std::shared_ptr<const Model> model = outer_.models->model(*lane.task.table, seeds, &why);
  if (!model) return why;
  Evaluator& evaluator = *lane.evaluator;
  // The evaluator may still refer to the one before.
  const std::shared_ptr<const Model> before = std::exchange(lane.model, std::move(model));
  // Squared distances are scaled by their values at the start.
  evaluator.set_time(0);
  const double t = lane.task.at ? lane.task.at->front() : 0;
  const char* obstacle = nullptr;
  try {
    evaluator.set_model(*lane.model);
    if (!check_time_functions(*lane.model, {t, t}).ok()) return "a function of time has no value then";
    evaluator.set_time(t);
    lane.start = evaluator.given_configuration();
    move_whole_turns(evaluator, lane.start);
    lane.q = lane.start;
    // Where the constraints of the scene have second derivatives those of a design lack them by chance alone.
    const bool is_linear = is_linear_ && (plan_->constant_jacobian || matrix_.constraints_are_linear(evaluator));
    obstacle = search_.set_design(number, evaluator, lane.q, is_linear);
  } catch (const std::invalid_argument&) {
    evaluator.set_model(*model_);
    return "it has other bodies or elements than the scene";
  }
  return obstacle ? obstacle : "";
}

LaneSet LaneRestDesigns::assemble(LaneSet lanes, std::span<Outcome> outcomes) {
  const LaneSet far = search_.unmet(lanes, thresholds::assembled);
  for_each_lane(far, [&](int number) {
    Lane& lane = lanes_[at(number)];
    if (Assembler(*lane.evaluator).assemble(lane.q).ok()) {
      search_.set_start(number, lane.q);
    } else {
      outcomes[at(number)].why_not = "it is not assembled by Newton's method alone";
      lanes &= ~(1U << number);
    }
  });
  if (far == 0) return lanes;
  for_each_lane(search_.unmet(far & lanes, descent::restored), [&](int number) {
    outcomes[at(number)].why_not = "it is assembled to rounding alone";
    lanes &= ~(1U << number);
  });
  return lanes;
}

void LaneRestDesigns::measure(std::span<const ParameterSeeds> designs, std::span<Outcome> outcomes) {
  search_.begin(static_cast<int>(designs.size()));
  LaneSet lanes = 0;
  for (int lane = 0; lane < static_cast<int>(designs.size()); ++lane) {
    Outcome& outcome = outcomes[at(lane)];
    outcome = {std::nullopt, prepare(lane, designs[at(lane)])};
    if (outcome.why_not.empty()) lanes |= 1U << lane;
  }
  if (lanes != 0) lanes = assemble(lanes, outcomes);
  if (lanes == 0) return;
  const LaneSet found = search_.find(lanes, tolerance_);
  for_each_lane(lanes & ~found, [&](int lane) { outcomes[at(lane)].why_not = search_.why(lane); });
  for_each_lane(found, [&](int lane) { take_measures(lane, outcomes[at(lane)]); });
}

void LaneRestDesigns::take_measures(int number, Outcome& outcome) {
  Lane& lane = lanes_[at(number)];
  Evaluator& evaluator = *lane.evaluator;
  search_.take(number, lane.q, lambda_);
  if (is_half_a_turn_off(*plan_, lane.start, lane.q)) {
    outcome.why_not = "whether a body has made a turn is a matter of rounding";
    return;
  }
  drop_whole_turns(*plan_, lane.start, lane.q);
  evaluator.set_configuration(lane.q);
  const double t = evaluator.time();
  measures_->begin_again(lane.task.measure_requests(), *lane.model, {t, t});
  const bool wants_multipliers = measures_->needs().multipliers;
  measures_->take_row({.evaluator = evaluator,
                       .t = t,
                       .q = lane.q,
                       .lambda = wants_multipliers ? std::span<const double>(lambda_) : std::span<const double>{},
                       .residual = search_.gap(number)},
                      true);
  std::vector<double> values;
  const std::vector<MeasureResult> results = measures_->results();
  auto next = results.begin();
  for (const PlacedMeasure& placed : lane.task.measures) {
    const bool is_energy = placed.request.kind == MeasureKind::field;
    const std::optional<double> value = is_energy ? evaluator.potential_energy() : next->value;
    if (!is_energy) ++next;
    if (!value || !std::isfinite(*value)) {
      outcome.why_not = fmt::format("measure \"{}\" has no value", placed.request.name);
      return;
    }
    values.push_back(*value);
  }
  outcome.measures = std::move(values);
}

}  // namespace catena
