// kinematics and inverse_dynamics: a driven mechanism over time.
#include <fmt/format.h>

#include "catena/analysis/accuracy/kinematic_accuracy.hpp"
#include "catena/analysis/adjoint/kinematic_adjoint.hpp"
#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/kinematics/kinematic_look.hpp"
#include "catena/analysis/kinematics/kinematics_with_events.hpp"
#include "catena/analysis/kinematics/minimum_norm_motion.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/sensitivity/kinematic_derivatives.hpp"
#include "catena/scene/judging/taut_ropes.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/event_entries.hpp"
#include "catena/scene/running/singular_entries.hpp"

namespace catena {
namespace {

/// A driven motion whose ropes meet and leave pulleys: they take no part in it, but for `taut` ones, but their columns
/// do. `obstacle`: what does not go on where one does, if anything.
template <class Analysis>
class WithRopes {
 public:
  WithRopes(Analysis& analysis, RopeWaysAt& ways, TautRopes& taut, std::string obstacle = {})
      : analysis_(analysis), ways_(ways), taut_(taut), begun_(ways.routes()), obstacle_(std::move(obstacle)) {
    if (taut.any()) obstacle_ = "a motion that a rope determines does not go on: end it before, or take dynamics";
  }

  const Plan& plan() const { return analysis_.plan(); }
  Evaluator& evaluator() { return analysis_.evaluator(); }
  void start_from(const SystemState& state) { analysis_.start_from(state); }
  SystemState state() const {
    SystemState state = analysis_.state();
    if (ended_well_) state.ropes = ways_.turns(state);
    return state;
  }
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& rows) {
    if (!ways_.any() && !taut_.any()) return analysis_.run(grid, needs, rows);
    Rows followed(*this, rows);
    AnalysisReport report = analysis_.run(grid, needs, followed);
    ended_well_ = report.ok();
    for (std::string& sentence : taut_.warnings()) report.warnings.push_back(std::move(sentence));
    return report;
  }

 private:
  class Rows final : public RowObserver {
   public:
    Rows(WithRopes& owner, RowObserver& target) : owner_(owner), target_(target) {}
    bool observe(const Snapshot& snapshot) override {
      owner_.follow(snapshot.q);
      owner_.taut_.observe(snapshot);
      return target_.observe(snapshot);
    }
    bool proceed(double t) override { return target_.proceed(t); }
    bool wants_stretches() const override { return target_.wants_stretches(); }
    bool cover(const MotionStretch& stretch) override { return target_.cover(stretch); }

   private:
    WithRopes& owner_;
    RowObserver& target_;
  };
  void follow(std::span<const double> q) {
    Evaluator& evaluator = analysis_.evaluator();
    const std::shared_ptr<const Model> before = ways_.model();
    if (!ways_.follow(evaluator)) return;
    if (!obstacle_.empty() && !ways_.lie_as(begun_)) {
      throw ModelError(fmt::format(
          "a rope meets or leaves a pulley, or has turned by nearly half a turn, by t = {:.12g} s, where {}",
          evaluator.time(), obstacle_));
    }
    evaluator.set_model(*ways_.model());
    evaluator.set_configuration(q);
    kept_.push_back(before);
  }

  Analysis& analysis_;
  RopeWaysAt& ways_;
  TautRopes& taut_;
  std::vector<RopeRoute> begun_;  // as they lay at first
  std::string obstacle_;
  bool ended_well_ = false;
  std::vector<std::shared_ptr<const Model>> kept_;  // columns refer to the first
};

/// Nothing, or why the ropes cannot be followed.
std::string trouble_of_ropes(const AnalysisContext& context, const RopeWaysAt& ways) {
  if (context.design && !ways.lie_as_given())
    return "derivatives are those of ropes that lie as in the given configuration; at the start one has met or left a "
           "pulley, or is wound further";
  for (const RopeRoute& route : ways.routes()) {
    const bool beside = std::find(route.off.begin(), route.off.end(), 1) != route.off.end();
    if (!beside || (!route.elastic && !context.design)) continue;
    return fmt::format(
        "rope \"{}\" lies beside a pulley, and where it meets one is not followed {}: leave the pulley out",
        context.model->element_name(route.element),
        route.elastic ? "in driven motions where it has a stiffness" : "with derivatives");
  }
  return {};
}

/// The first joint with friction; -1: none.
int first_joint_friction(const Model& model) {
  const std::vector<ContactPoint> joints = joints_with_friction(model);
  return joints.empty() ? -1 : joints.front().element;
}

/// Nothing, or why a motion that ropes determine cannot be had.
std::string trouble_of_taut(const AnalysisContext& context, const TautRopes& taut, bool inverse_dynamics) {
  if (!taut.any()) return {};
  if (context.design)
    return fmt::format("a motion that the ropes {} determine has no derivatives yet: take dynamics", taut.names());
  if (inverse_dynamics && first_joint_friction(*context.model) >= 0) {
    return fmt::format(
        "the friction of \"{}\" is not found together with the tension of {}, without which the motion is not "
        "determined: leave the friction out, or take dynamics",
        context.model->element_name(first_joint_friction(*context.model)), taut.names());
  }
  return {};
}

/// Whether constraints and drivers determine the motion where the analysis starts.
bool is_driven(const AnalysisContext& context) {
  Kinematics analysis(context.model, plan_without_gaps(*context.model, {}, context.state));
  analysis.start_from(context.state);
  RowFunction nothing([](const Snapshot&) { return true; });
  return analysis.run(TimeGrid::instant(context.state.t), {}, nothing).status != Status::under_driven;
}

bool changes_mechanism(const EventRequest& event) {
  const auto action = static_cast<EventAction>(event.action);
  return action == EventAction::release || action == EventAction::engage;
}

/// Nothing, or why a driven motion cannot have these events, loads or such a branch.
std::string conflict(const AnalysisContext& context, bool inverse_dynamics) {
  for (const EventRequest& event : context.task.events) {
    if (event.impulse) {
      return fmt::format("event \"{}\": an impulse changes no motion that drivers determine; strike in dynamics",
                         event.name);
    }
    if (!changes_mechanism(event)) continue;
    if (inverse_dynamics) {
      return fmt::format(
          "event \"{}\": velocities may jump where a constraint comes or goes, and no finite load makes them; release "
          "and engage in kinematics or dynamics",
          event.name);
    }
    if (context.design) return "derivatives are not carried through events that release or engage a constraint";
  }
  if (inverse_dynamics && context.design && first_joint_friction(*context.model) >= 0) {
    return fmt::format("loads with the friction of \"{}\" have no derivatives yet: leave it out, or take dynamics",
                       context.model->element_name(first_joint_friction(*context.model)));
  }
  const AnalysisTask& task = context.task;
  return task.has("branch") && task.number("branch", 0) < 1 ? "branches are numbered from 1" : "";
}

void differentiate(AnalysisContext& context, AnalysisRows& rows, const Evaluator& evaluator) {
  const auto parameters = static_cast<int>(context.design->names.size());
  if (goes_back(context))
    rows.differentiate(std::make_unique<KinematicAdjoint>(evaluator, designs_of(context), parameters));
  else
    rows.differentiate(std::make_unique<KinematicDerivatives>(evaluator, designs_of(context), parameters));
}

/// The same motion with events; rows, measures and derivatives as without.
void run_with_events(AnalysisContext& context, AnalysisResult& result, const TimeGrid& grid,
                     const KinematicsOptions& options, const ColumnSources& sources, RopeWaysAt& ways,
                     TautRopes& taut) {
  const AnalysisTask& task = context.task;
  std::vector<std::string> reactions = task.column_names();
  for (const EventRequest& request : task.events) reactions.push_back(request.column);
  PlanOptions plan = plan_without_gaps(*context.model, reactions, context.state);
  taut.add_rows(plan);
  KinematicsWithEvents analysis(context.model, plan, options, events_of(task, *context.model, context.state.held),
                                sources);
  WithRopes watched(analysis, ways, taut, "a motion with events does not go on: end it before, or do without events");
  run_over_time(context, result, watched, grid, task.output_names(), sources, [&](AnalysisRows& rows) {
    rows.watch_gaps(*context.model);
    if (!context.design) return;
    differentiate(context, rows, analysis.evaluator());
  });
  add_singular_points(result, analysis.singular_points(), *context.model);
  EventEntries entries(*context.model);
  entries.add(task, analysis.records());
  entries.give(result, true);
}

/// Nothing, or why a motion that nothing drives cannot be had.
std::string trouble_without_drivers(const AnalysisContext& context, bool inverse_dynamics) {
  if (inverse_dynamics) {
    return "\"minimum_norm\" is for kinematics alone: motions that nothing drives would need forces of their own; add "
           "drivers";
  }
  if (context.design) return "motions that nothing drives have no derivatives yet: leave \"free\" out, or add drivers";
  if (!context.task.events.empty()) {
    return "events are not looked for in a motion of least velocity, which is not looked at between its rows: leave "
           "\"free\" out and add drivers";
  }
  return {};
}

/// A motion that constraints and drivers do not determine.
void run_of_least_velocity(AnalysisContext& context, AnalysisResult& result, const TimeGrid& grid,
                           const PlanOptions& plan, const ColumnSources& sources, RopeWaysAt& ways, TautRopes& taut) {
  MinimumNormMotion analysis(context.model, plan);
  WithRopes followed(analysis, ways, taut);
  run_over_time(context, result, followed, grid, context.task.output_names(), sources, [&](AnalysisRows& rows) {
    rows.watch_gaps(*context.model);
    rows.take_rows_alone();
  });
  add_singular_points(result, analysis.singular_points(), *context.model);
}

/// What of the motion does not go on where a rope meets or leaves a pulley.
std::string obstacle_for_ropes(const AnalysisContext& context) {
  if (context.design) return "derivatives do not go on: end the analysis before";
  const std::vector<PlacedMeasure>& measures = context.task.measures;
  const bool looks_between = std::any_of(measures.begin(), measures.end(), [](const PlacedMeasure& measure) {
    return measure.request.kind != MeasureKind::final && measure.request.kind != MeasureKind::first;
  });
  return looks_between ? "measures of what is between rows do not go on: end the analysis before" : "";
}

bool is_forwards(const TimeGrid& grid, double t) {
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    if (grid[k] < t) return false;
    t = grid[k];
  }
  return true;
}

void run(AnalysisContext& context, AnalysisResult& result, bool inverse_dynamics) {
  const AnalysisTask& task = context.task;
  if (const std::string why = conflict(context, inverse_dynamics); !why.empty()) return refuse(result, why);
  RopeWaysAt ways(context.model);
  // The given configuration may be an estimate: then the first place that is assembled says how ropes lie.
  if (!context.state.q.empty() && ways.begin(context.state)) context.model = ways.model();
  if (const std::string why = trouble_of_ropes(context, ways); !why.empty()) return refuse(result, why);
  const std::optional<TimeGrid> grid = time_grid(context, result.report);
  if (!grid) return;
  TautRopes taut(context.model, plan_without_gaps(*context.model, {}, context.state), context.state);
  if (const std::string why = trouble_of_taut(context, taut, inverse_dynamics); !why.empty())
    return refuse(result, why);
  PlanOptions plan = plan_without_gaps(*context.model, task.column_names(), context.state);
  taut.add_rows(plan);
  KinematicsOptions options;
  options.inverse_dynamics = inverse_dynamics;
  if (task.has("branch")) options.branch = static_cast<int>(task.number("branch", 0));
  const ColumnSources sources{.analysis = task.type(),
                              .timed = true,
                              .velocity = true,
                              .acceleration = true,
                              .multipliers = inverse_dynamics,
                              .work = inverse_dynamics};
  if (task.word("free") != 0 && !taut.any() && !is_driven(context)) {
    if (const std::string why = trouble_without_drivers(context, inverse_dynamics); !why.empty())
      return refuse(result, why);
    return run_of_least_velocity(context, result, *grid, plan, sources, ways, taut);
  }
  // What events of motions before have engaged may hold whole turns away from its value.
  const bool goes_on = !context.state.held.empty() && is_forwards(*grid, context.state.t);
  if (goes_on || !task.events.empty()) return run_with_events(context, result, *grid, options, sources, ways, taut);
  Kinematics analysis(context.model, plan, options);
  std::optional<KinematicLook> look, drawn;
  const auto prepare = [&](AnalysisRows& rows) {
    rows.watch_gaps(*context.model);
    if (!task.measures.empty()) {
      look.emplace(context.model, plan, options, rows.measured_needs());
      rows.look_by([&](const Snapshot& snapshot) {
        look->start_from(snapshot);
        return AnalysisRows::Look([&](double t) { return look->at(t); });
      });
    }
    // Rates found on the way would serve as predictions, and rows would differ in their last digits by being drawn.
    // Where the rows have them anyway nothing more is looked for.
    const Needs wanted = rows.drawn_needs(), asked = rows.asked_needs();
    if ((wanted.velocity && !asked.velocity) || (wanted.multipliers && !asked.multipliers)) {
      drawn.emplace(context.model, plan, options, wanted);
      rows.draw_by([&](const Snapshot& snapshot) {
        drawn->start_from(snapshot);
        return drawn->at(snapshot.t);
      });
    }
    const bool rubs = inverse_dynamics && !context.model->frictions().empty();
    if (context.digits && !context.design && !rubs)
      rows.judge(std::make_unique<KinematicAccuracy>(analysis, rows.columns()));
    if (context.design) differentiate(context, rows, analysis.evaluator());
  };
  WithRopes followed(analysis, ways, taut, obstacle_for_ropes(context));
  run_over_time(context, result, followed, *grid, task.output_names(), sources, prepare);
  add_singular_points(result, analysis.singular_points(), *context.model);
}

}  // namespace

void run_kinematics(AnalysisContext& context, AnalysisResult& result) {
  run(context, result, false);
  add_field_measures(context, result);
}
void run_inverse_dynamics(AnalysisContext& context, AnalysisResult& result) {
  run(context, result, true);
  if (const int rope = first_gripped_rope(*context.model); rope >= 0 && result.report.ok()) {
    result.report.warnings.push_back(
        fmt::format("friction of rope \"{}\" on pulleys is left out: what it does depends on how the rope came there, "
                    "which dynamics "
                    "follows",
                    context.model->element_name(rope)));
  }
  add_field_measures(context, result);
}

}  // namespace catena
