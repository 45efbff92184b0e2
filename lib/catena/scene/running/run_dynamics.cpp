// dynamics: the motion that follows from forces; with events, an estimate of its error, or checkpoints.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "catena/analysis/accuracy/compared_rows.hpp"
#include "catena/analysis/accuracy/motion_digits.hpp"
#include "catena/analysis/adjoint/motion_measures.hpp"
#include "catena/analysis/adjoint/phased_measures.hpp"
#include "catena/analysis/contact/rope_grips.hpp"
#include "catena/analysis/dynamics/dynamics_of_islands.hpp"
#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/analysis/dynamics/error_estimate.hpp"
#include "catena/analysis/dynamics/paces.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/model/elastic_gaps.hpp"
#include "catena/model/rope_routes.hpp"
#include "catena/scene/models/design_events.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/event_entries.hpp"
#include "catena/scene/running/singular_entries.hpp"

namespace catena {
namespace {

constexpr ColumnSources sources{
    .analysis = "dynamics", .timed = true, .velocity = true, .acceleration = true, .multipliers = true, .work = true};
// Of an analysis: time between checkpoints where none is given.
constexpr double part_between_checkpoints = 0.05;

DynamicsOptions options_of(const AnalysisTask& task) {
  DynamicsOptions options;
  options.method = static_cast<IntegrationMethod>(task.word("method"));  // in the order of the key's words
  options.tolerance = task.number("tolerance", options.tolerance);
  options.step = task.number("step", options.step);
  options.rho = task.number("rho", options.rho);
  options.max_steps = static_cast<std::int64_t>(task.number("max_steps", static_cast<double>(options.max_steps)));
  return options;
}

class DynamicsTask {
 public:
  DynamicsTask(AnalysisContext& context, AnalysisResult& result)
      : context_(context),
        result_(result),
        model_(context.model),
        options_(options_of(context.task)),
        used_options_(options_),
        names_(context.task.output_names()),
        touches_(!model_->gaps().empty() || !model_->frictions().empty() || first_gripped_rope(*model_) >= 0),
        routes_(rope_routes(*model_)),
        estimates_(context.estimate_error || context.task.number("estimate_error", 0) != 0) {}

  void run();
  /// How instants of the motion move with the parameters.
  const InstantRates& instants() const { return *instants_; }

 private:
  /// Nothing, or why the analysis cannot do all that is asked for at once.
  std::string conflict() const;
  /// Runs what was made with used_options_.
  /// `make`: another one, with other options.
  template <class Analysis, class Make>
  void run_or_estimate(Analysis& analysis, const PlanOptions& plan, Make make);
  /// Has the rows told how many of their digits are right. Ropes that meet and leave pulleys change the mechanism.
  template <class Analysis, class Make>
  void judge(AnalysisRows& rows, Analysis& analysis, Make make) {
    if (!context_.digits || context_.design || context_.checkpoint) return;
    const bool changes = changes_itself() || follows_ropes();
    const AskedMotion motion{sources, context_.state, *grid_, options_, changes, context_.cancel};
    rows.judge(accuracy_of_motion(analysis, rows.columns(), motion, make));
  }
  /// Says so where the error of a method whose errors of steps add up was not compared with its tolerance.
  void warn_of_unknown_error();
  /// Runs what was prepared.
  void run_on();
  void run_with_events_or_pauses();
  void differentiate(AnalysisRows& rows, const Evaluator& evaluator);
  void differentiate(AnalysisRows& rows, Dynamics& analysis) { differentiate(rows, analysis.evaluator()); }
  void differentiate(AnalysisRows& rows, DynamicsWithEvents& analysis);
  DerivativeAim aim() const;
  /// Whether the motion has contacts, friction or events that act.
  bool changes_itself() const;
  /// Whether instants of the motion itself are to be differentiated.
  bool has_phases() const;
  bool only_strikes() const;
  /// Has elastic cables and ropes followed as places that press: derivatives ask for steps that end where one of them
  /// becomes taut or slack.
  void follow_kinks();
  /// Whether one does, or may: of a motion that changes itself it is not asked.
  bool passes_kinks() const;
  DesignModels designs() const;
  /// Has the motion saved now and then; where it cannot be, `failure` says why.
  Pauses pauses(std::string& failure) const;
  void run_apart(const std::vector<std::vector<int>>& classes);
  /// Whether ropes are followed over pulleys: not where another run would have to do the same. Where they are not they
  /// begin as they lie at the start, and keep their pulleys.
  bool follows_ropes() const { return !routes_.empty() && !estimates_ && !context_.design; }
  /// Of a motion without events and contacts.
  void add_jolts(const std::vector<Jolt>& jolts) {
    EventEntries entries(*model_);
    entries.add(jolts);
    entries.give(result_, false);
  }

  AnalysisContext& context_;
  AnalysisResult& result_;
  std::shared_ptr<const Model> model_;
  DynamicsOptions options_, used_options_;  // what was asked for; those of the finer run where the error is wanted
  std::vector<std::string> names_;
  std::optional<TimeGrid> grid_;
  bool touches_;  // it has contacts, or friction
  std::vector<RopeRoute> routes_;
  bool estimates_;
  PlanOptions plan_;  // with which it runs
  std::shared_ptr<InstantRates> instants_ = std::make_shared<InstantRates>();
  bool follows_kinks_ = false,
       only_kinks_ = false;  // elastic cables and ropes are places that press; there are no others
};

std::string DynamicsTask::conflict() const {
  if (const int rope = first_gripped_rope(*model_); context_.design && rope >= 0) {
    return fmt::format("rope \"{}\" rubs on a pulley (mu): derivatives of its tensions are not built",
                       model_->element_name(rope));
  }
  const std::vector<EventRequest>& events = context_.task.events;
  if (estimates_ && std::any_of(events.begin(), events.end(), acts)) {
    return "the error cannot be estimated where events release or engage a constraint or strike a body: they would "
           "happen at other instants in the second run";
  }
  if (touches_ && estimates_) {
    return "the error cannot be estimated where contacts open and close: they would do so at other instants in the "
           "second run";
  }
  const auto lies_beside = [](const RopeRoute& route) {
    return std::find(route.off.begin(), route.off.end(), 1) != route.off.end();
  };
  if (const auto found = std::find_if(routes_.begin(), routes_.end(), lies_beside);
      found != routes_.end() && !follows_ropes()) {
    return fmt::format(
        "rope \"{}\" lies beside a pulley, and where it meets one is not followed with derivatives or an estimate of "
        "the "
        "error: leave these out, or the pulley",
        model_->element_name(found->element));
  }
  if (touches_ && context_.checkpoint)
    return "checkpoints do not keep the state of contacts: run without --checkpoint and --restart";
  if (context_.design && context_.checkpoint) return "derivatives and checkpoints do not go together";
  if (options_.method != IntegrationMethod::alpha && context_.task.number("rho", -1) >= 0)
    return "\"rho\" is how strongly method alpha damps, and the method is another: leave it out";
  if (context_.design && !is_explicit(options_.method)) {
    return fmt::format(
        "derivatives of a motion follow explicit steps, which those of method {} are not: leave \"method\" out",
        to_string(options_.method));
  }
  if (context_.checkpoint && estimates_) return "an estimate of the error and checkpoints do not go together";
  return {};
}

template <class Analysis, class Make>
void DynamicsTask::run_or_estimate(Analysis& analysis, const PlanOptions& plan, Make make) {
  if (!estimates_) {
    run_over_time(context_, result_, analysis, *grid_, names_, sources, [&](AnalysisRows& rows) {
      differentiate(rows, analysis);
      judge(rows, analysis, make);
    });
    return;
  }
  WithErrorEstimate both(analysis, model_, plan, options_);
  run_over_time(context_, result_, both, *grid_, names_, sources, [&](AnalysisRows& rows) {
    differentiate(rows, analysis);
    if (!context_.digits || context_.design) return;
    auto compared =
        std::make_unique<ComparedRows>(rows.columns(), [&analysis]() -> Evaluator& { return analysis.evaluator(); });
    both.show_asked(*compared);
    rows.judge(std::move(compared));
  });
  add_estimated_error(result_, both.error(), *model_);
}

bool DynamicsTask::passes_kinks() const {
  if (changes_itself()) return true;
  Dynamics motion(model_, plan_options(*model_, {}, context_.state), used_options_);
  motion.start_from(context_.state);
  KinkLook look(*model_, context_.cancel);
  static_cast<void>(motion.run(*grid_, {}, look));  // where it does not end well the run itself says so
  return look.passed();
}

void DynamicsTask::follow_kinks() {
  follows_kinks_ = true;
  only_kinks_ = !std::exchange(touches_, true);
  model_ = with_elastic_gaps(*model_);
}

DesignModels DynamicsTask::designs() const {
  DesignModels models = designs_of(context_);
  for (auto& model : models) {
    if (follows_kinks_) model = with_elastic_gaps(*model);
  }
  return models;
}

DerivativeAim DynamicsTask::aim() const {
  const std::vector<double> values = context_.models->values(*context_.task.table, context_.seeds);
  DerivativeAim aim{options_.step > 0 ? std::numeric_limits<double>::infinity() : used_options_.tolerance, {}};
  for (const int parameter : context_.design->parameters)
    aim.sizes.push_back(values[static_cast<std::size_t>(parameter)]);
  return aim;
}

void DynamicsTask::differentiate(AnalysisRows& rows, const Evaluator& evaluator) {
  if (!context_.design) return;
  const GivenByModel start{context_.state.q.empty(), context_.state.qd.empty()};
  const auto parameters = static_cast<int>(context_.design->names.size());
  const std::string_view obstacle = estimates_ ? "an estimate of the error is wanted" : "";
  if (goes_back(context_, obstacle))
    rows.differentiate_back(std::make_unique<MotionMeasures>(evaluator, designs(), parameters, start, aim()));
  else
    rows.differentiate(std::make_unique<MotionDerivatives>(evaluator, designs(), parameters, start, aim()));
}

bool DynamicsTask::changes_itself() const {
  const auto& events = context_.task.events;
  return touches_ || std::any_of(events.begin(), events.end(), acts);
}

bool DynamicsTask::has_phases() const {
  const auto& measures = context_.task.measures;
  return changes_itself() || std::any_of(measures.begin(), measures.end(), reads_events);
}

/// Whether blows of events alone make the phases of a motion.
bool DynamicsTask::only_strikes() const {
  const auto& events = context_.task.events;
  return !touches_ &&
         std::none_of(events.begin(), events.end(), [](const EventRequest& e) { return acts(e) && !e.impulse; });
}

void DynamicsTask::differentiate(AnalysisRows& rows, DynamicsWithEvents& analysis) {
  if (!context_.design) return;
  const GivenByModel given{context_.state.q.empty(), context_.state.qd.empty()};
  if (!has_phases()) {
    differentiate(rows, analysis.evaluator());
    return;
  }
  const auto& measures = context_.task.measures;
  const bool instants = std::any_of(measures.begin(), measures.end(), reads_events);
  const bool back = goes_back(context_, instants ? "instants of events are measured" : "", !only_strikes());
  const DerivativeAim aim = this->aim();
  const DesignModels designs = this->designs();
  PhasedDesign design =
      phased_design(designs, aim.sizes, context_.task,
                    context_.models->moving_numbers(context_.task, context_.seeds, context_.design->parameters), model_,
                    plan_, analysis.plan(), sources);
  design.aim = aim;
  if (back && only_strikes()) {
    auto backwards = std::make_unique<MotionMeasures>(analysis.evaluator(), designs, design.parameters, given, aim);
    backwards->follow(std::move(design.events));
    analysis.witness(backwards.get());
    rows.differentiate_back(std::move(backwards));
    return;
  }
  if (back) {
    auto backwards = std::make_unique<PhasedMeasures>(std::move(design), given);
    analysis.witness(backwards.get());
    rows.differentiate_back(std::move(backwards));
    return;
  }
  auto derivatives = std::make_unique<PhasedDerivatives>(std::move(design), given, instants_);
  analysis.witness(derivatives.get());
  rows.differentiate(std::move(derivatives));
}

Pauses DynamicsTask::pauses(std::string& failure) const {
  const CheckpointRequest& request = *context_.checkpoint;
  const double begin = context_.state.t;
  Pauses pauses{request.every > 0 ? request.every : part_between_checkpoints * (grid_->last() - begin)};
  pauses.save = [&request, &failure, begin](const MotionMemory& memory) {
    try {
      request.save(begin, memory);
    } catch (const CheckpointError& error) {
      failure = error.what();  // of a run of hours the rows are worth more than its checkpoints
    }
  };
  return pauses;
}

void DynamicsTask::run_with_events_or_pauses() {
  std::vector<std::string> reactions = context_.task.column_names();
  for (const EventRequest& request : context_.task.events) reactions.push_back(request.column);
  const PlanOptions plan = plan_options(*model_, reactions, context_.state);
  const std::vector<Event> events = events_of(context_.task, *model_, context_.state.held);
  DynamicsWithEvents analysis(model_, plan, used_options_, events, sources, follows_ropes());
  std::string failure, taken_up;
  if (context_.checkpoint) {
    analysis.pause(pauses(failure));
    if (const std::optional<Checkpoint>& restart = context_.checkpoint->restart) {
      analysis.resume(restart->motion);
      taken_up = fmt::format("taken up from a checkpoint at t = {:.12g} s: the {} rows before are not given again",
                             restart->motion.t, restart->motion.rows_given);
    }
  }
  plan_ = plan;
  run_or_estimate(analysis, plan, [this, plan, events](const DynamicsOptions& options) {
    return std::make_unique<DynamicsWithEvents>(model_, plan, options, events, sources, follows_ropes());
  });
  add_singular_points(result_, analysis.singular_points(), *model_);
  std::vector<std::string>& warnings = result_.report.warnings;
  if (!failure.empty()) warnings.push_back("a checkpoint was not saved: " + failure);
  if (!taken_up.empty()) warnings.push_back(taken_up);
  result_.fields.push_back({"method", names_of(analysis.methods())});
  EventEntries entries(*model_);
  entries.add(context_.task, analysis.records());
  entries.add(analysis.contact_events());
  entries.add(analysis.jolts());
  entries.give(result_, !context_.task.events.empty() || (analysis.has_contacts() && !only_kinks_));
}

/// Mechanisms that have nothing to do with each other, and differ in pace.
void DynamicsTask::run_apart(const std::vector<std::vector<int>>& classes) {
  const PlanOptions plan = plan_options(*model_, names_, context_.state);
  DynamicsOfIslands analysis(model_, plan, used_options_, classes);
  run_over_time(context_, result_, analysis, *grid_, names_, sources, [&](AnalysisRows& rows) {
    judge(rows, analysis, [model = model_, plan, classes](const DynamicsOptions& options) {
      return std::make_unique<DynamicsOfIslands>(model, plan, options, classes);
    });
  });
  add_singular_points(result_, analysis.singular_points(), *model_);
  result_.fields.push_back({"method", names_of(analysis.methods())});
  result_.fields.push_back({"integrated_apart", static_cast<std::int64_t>(analysis.classes())});
  EventEntries entries(*model_);
  entries.add(analysis.contact_events());
  entries.add(analysis.jolts());
  entries.give(result_, touches_);
}

void DynamicsTask::run() {
  if (const std::string why = conflict(); !why.empty()) return refuse(result_, why);
  if (context_.checkpoint && context_.checkpoint->restart) {
    context_.state = {context_.checkpoint->restart->begin, {}, {}};
    context_.state.held = context_.checkpoint->restart->motion.events.held;
  }
  grid_ = time_grid(context_, result_.report);
  if (!grid_) return;
  std::optional<RopeWaysAt> ways;
  if (!routes_.empty() && !follows_ropes()) {
    ways.emplace(model_);
    if (ways->begin(context_.state)) {
      if (ways->has_changed() || context_.design)
        return refuse(result_,
                      "a rope lies otherwise at the start than in the given configuration, which derivatives "
                      "and estimates of the error do not follow: leave these out, or give the bodies a place nearer to "
                      "the start");
      model_ = ways->model();
    }
  }
  run_on();
  warn_of_unknown_error();
  if (ways && result_.report.ok()) context_.state.ropes = ways->turns(context_.state);
}

void DynamicsTask::warn_of_unknown_error() {
  const bool judges_steps_alone = options_.method == IntegrationMethod::alpha && options_.step == 0;
  if (!judges_steps_alone || !result_.report.ok() || estimates_ || !result_.digits.empty()) return;
  result_.report.warnings.push_back(
      "how many tolerances the motion is off is not known: alpha judges each step by itself, and the second run that "
      "tells it was not made, or ended otherwise (digits_note); estimate_error tells it, too");
}

void DynamicsTask::run_on() {
  if (estimates_) used_options_ = finer_options(options_);
  if (context_.design) used_options_.may_turn_implicit = false;
  if (context_.design && !estimates_ && may_have_elastic_gaps(*model_) && passes_kinks()) follow_kinks();
  const bool acts = !context_.task.events.empty() || !context_.state.held.empty();
  const bool in_common = acts || context_.checkpoint || follows_ropes();
  // A fixed step is the same for all; two runs that are compared must be divided alike.
  const bool looked_at = context_.design || !context_.task.measures.empty();
  // What is released is told by its number among all.
  const bool whole = context_.state.released.empty();
  if (!in_common && !estimates_ && options_.step == 0 && !looked_at && whole) {
    if (const auto classes = classes_of_pace(model_); classes.size() > 1) return run_apart(classes);
  }
  if (in_common || touches_) return run_with_events_or_pauses();
  const PlanOptions plan = plan_options(*model_, context_.task.column_names(), context_.state);
  Dynamics analysis(model_, plan, used_options_);
  run_or_estimate(analysis, plan, [model = model_, plan](const DynamicsOptions& options) {
    return std::make_unique<Dynamics>(model, plan, options);
  });
  add_singular_points(result_, analysis.singular_points(), *model_);
  result_.fields.push_back({"method", names_of(analysis.methods())});
  add_jolts(analysis.jolts());
}

}  // namespace

void run_dynamics(AnalysisContext& context, AnalysisResult& result) {
  DynamicsTask task(context, result);
  task.run();
  add_field_measures(context, result);
  if (context.design) set_event_gradients(context, result, task.instants());
}

}  // namespace catena
