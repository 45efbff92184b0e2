#include "catena/scene/running/scene_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "catena/analysis/run/name_list.hpp"
#include "catena/scene/models/scene_saving.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/event_entries.hpp"
#include "catena/scene/running/scene_setup.hpp"

namespace catena {
namespace {

void print_iteration(std::string_view method, int iteration, double residual, double change) {
  const std::string line = fmt::format("{} {}: residual {:.3g}, change {:.3g}\n", method, iteration, residual, change);
  std::fputs(line.c_str(), stderr);
}

class SceneRun {
 public:
  SceneRun(SceneSetup& setup, const RunOptions& options, SceneOutcome& outcome)
      : setup_(setup), options_(options), outcome_(outcome) {}

  void run(ResultSink& sink);

 private:
  void save();
  /// The task with the parameters that earlier paths and optimisations left behind, unless it sets them itself.
  AnalysisTask with_handed_on(AnalysisTask task, std::optional<std::string>& why_not);
  ParameterSeeds handed_on_to(const AnalysisTask& task) const;
  std::string why_not_from_checkpoint(const AnalysisTask& task, int number) const;
  SceneSetup::NamedValues changed_parameters(const AnalysisTask& task);
  AnalysisResult run_task(const AnalysisTask& read, int number, SystemState& state, RowSink& rows);
  void run_in(AnalysisContext& context, AnalysisResult& result);

  SceneSetup& setup_;
  const RunOptions& options_;
  SceneOutcome& outcome_;
  bool asks_for_digits(const AnalysisTask& task) const;
  bool claims_digits(const AnalysisTask& task) const;
  void note_origin_of_state(const AnalysisTask& task);

  bool inexact_ = false;    // the state has errors of an earlier motion, which no later analysis knows
  ParameterSeeds at_ends_;  // values of parameters where paths ended: until an analysis starts from the beginning
  ParameterSeeds optimum_;  // those that optimisations found: for all later analyses
};

/// Whether places and rates follow from the model alone, whatever the state before.
bool makes_own_state(const AnalysisTask& task) {
  if (task.type() == "equilibrium" || task.type() == "path") return true;
  const bool driven = task.type() == "kinematics" || task.type() == "inverse_dynamics";
  return driven && task.word("free") == 0;  // "refuse"; else they depend on where they start
}

/// Whether digits of analyses of this type can be told.
bool has_digits(const AnalysisTask& task) {
  return std::any_of(task.description->keys.begin(), task.description->keys.end(),
                     [](const AnalysisKey& key) { return key.name == "digits"; });
}

/// Whether the analysis leaves a state that has errors of a motion.
bool integrates(const AnalysisTask& task) {
  return task.type() == "dynamics" || std::any_of(task.of.begin(), task.of.end(), integrates);
}

bool SceneRun::asks_for_digits(const AnalysisTask& task) const {
  return options_.digits && task.number("digits", 1) != 0;
}

// Digits are claimed of what an analysis does itself: where it goes on from a motion with errors, it claims none.
bool SceneRun::claims_digits(const AnalysisTask& task) const {
  return asks_for_digits(task) && (!inexact_ || makes_own_state(task));
}

void SceneRun::note_origin_of_state(const AnalysisTask& task) {
  if (integrates(task))
    inexact_ = true;
  else if (makes_own_state(task))
    inexact_ = false;
}

ParameterSeeds SceneRun::handed_on_to(const AnalysisTask& task) const {
  ParameterSeeds seeds;
  const std::vector<int>& set = task.set_parameters;
  const auto take = [&](const ParameterSeed<double>& seed) {
    const auto same = [&](const auto& other) { return other.index == seed.index; };
    const bool is_set = std::find(set.begin(), set.end(), seed.index) != set.end();
    if (!is_set && std::none_of(seeds.begin(), seeds.end(), same)) seeds.push_back(seed);
  };
  std::for_each(at_ends_.begin(), at_ends_.end(), take);
  std::for_each(optimum_.begin(), optimum_.end(), take);
  return seeds;
}

AnalysisTask SceneRun::with_handed_on(AnalysisTask task, std::optional<std::string>& why_not) {
  const ParameterSeeds seeds = handed_on_to(task);
  if (seeds.empty()) return task;
  why_not = setup_.models().set_parameters(task, seeds);
  task.changes_parameters = true;
  return task;
}

// Nothing, or why a run that goes on from a checkpoint cannot begin with this analysis.
std::string SceneRun::why_not_from_checkpoint(const AnalysisTask& task, int number) const {
  const std::vector<AnalysisTask>& tasks = setup_.tasks();
  const bool follows_path = std::any_of(tasks.begin(), tasks.begin() + number,
                                        [](const AnalysisTask& earlier) { return earlier.type() == "path"; });
  if (number != setup_.checkpoints().first_analysis() || task.from_initial || !follows_path) return {};
  return "a checkpoint does not keep the parameter that a path before it ended with: run the whole scene";
}

// The parameters that a task sets, and those that differ with them.
SceneSetup::NamedValues SceneRun::changed_parameters(const AnalysisTask& task) {
  SceneSetup::NamedValues changed;
  if (!task.changes_parameters) return changed;
  const SceneSetup::NamedValues before = setup_.given_parameters(), own = setup_.named(task.parameters);
  const JsonValue set = task.place.find("set");
  for (std::size_t k = 0; k < own.size(); ++k) {
    if ((set && set.find(own[k].first)) || own[k].second != before[k].second) changed.push_back(own[k]);
  }
  return changed;
}

/// Whether what an analysis does begins with all that the scene has: itself, or the first one inside it.
bool begins_anew(const AnalysisTask& task) {
  return task.from_initial || (!task.of.empty() && begins_anew(task.of.front()));
}

/// What does not hold from the start, since an analysis before has left it so, and no event of this one engages.
void tell_of_released(const Model& model, const std::vector<int>& released, const AnalysisTask& task, Report& report) {
  if (released.empty() || begins_anew(task)) return;
  const std::vector<Event> events = events_of(task, model);
  NameList names;
  for (const int element : released) {
    const bool engaged = std::any_of(events.begin(), events.end(), [&](const Event& event) {
      return event.action == EventAction::engage && event.element == element;
    });
    if (!engaged) names.add(model.element_name(element));
  }
  if (names.count() == 0) return;
  report.warnings.push_back(
      fmt::format("released where the analysis before ended, and not held in this one: {}; \"from\": \"initial\" "
                  "begins with all that the scene has",
                  names.text()));
}

AnalysisResult SceneRun::run_task(const AnalysisTask& read, int number, SystemState& state, RowSink& rows) {
  AnalysisResult result;
  std::optional<std::string> unfit;
  const AnalysisTask task = with_handed_on(read, unfit);
  result.type = task.type();
  std::string why_not = why_not_from_checkpoint(read, number);
  if (why_not.empty() && unfit)
    why_not = fmt::format("with the parameters that an analysis before left behind: {}", *unfit);
  if (!why_not.empty()) {
    refuse(result, std::move(why_not));
    return result;
  }
  CheckpointRequest checkpoint = setup_.checkpoints().request(number);
  AnalysisContext context{.task = task,
                          .model = setup_.model_for(task),
                          .state = state,
                          .rows = rows,
                          .cancel = options_.cancel,
                          .progress = {},
                          .verbose = options_.verbose,
                          .trace = options_.verbose ? IterationTrace(print_iteration) : IterationTrace(),
                          .models = &setup_.models(),
                          .seeds = handed_on_to(read),
                          .parameter_name = {},
                          .estimate_error = options_.estimate_error,
                          .checkpoint = setup_.checkpoints().wanted() ? &checkpoint : nullptr,
                          .poses = options_.poses,
                          .digits = claims_digits(task),
                          .threads = options_.threads,
                          .sweep = {.record = setup_.record(),
                                    .link = options_.link,
                                    .patience = options_.patience,
                                    .owner = setup_.sweep_owner(),
                                    .analysis = number + 1}};
  if (context.poses) context.poses->begin_poses(context.model);
  result.set = changed_parameters(task);
  if (task.has("parameter"))
    context.parameter_name = setup_.parameter_names().all()[static_cast<std::size_t>(task.word("parameter"))];
  if (options_.progress) {
    context.progress = [&, number](double fraction) {
      options_.progress({task.type(), number, static_cast<int>(setup_.tasks().size()), fraction});
    };
  }
  const std::vector<int> released = state.released;
  run_in(context, result);
  tell_of_released(*context.model, released, task, result.report);
  if (result.report.ok() && has_digits(task) && !asks_for_digits(task))
    result.fields.push_back({"digits_note", std::string("no digits are claimed: they were not asked for")});
  note_origin_of_state(task);
  return result;
}

void SceneRun::run_in(AnalysisContext& context, AnalysisResult& result) {
  try {
    run_analysis(context, result);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(result, error.what());
  }
  for (const ParameterSeed<double>& value : context.values_at_end) {
    const auto same = [&](const auto& seed) { return seed.index == value.index; };
    std::erase_if(at_ends_, same);
    ParameterSeeds& kept = context.task.type() == "optimise" ? optimum_ : at_ends_;
    std::erase_if(kept, same);
    kept.push_back(value);
  }
}

void SceneRun::run(ResultSink& sink) {
  SystemState state;
  const Model& model = *setup_.model();
  const std::vector<AnalysisTask>& tasks = setup_.tasks();
  if (options_.poses) options_.poses->begin_poses(setup_.model());
  sink.begin_run({.scene = outcome_.scene,
                  .description = std::string(setup_.scene().description),
                  .gravity = {model.gravity.x, model.gravity.y},
                  .bodies = static_cast<int>(model.bodies.size()),
                  .elements = static_cast<int>(model.elements.size()),
                  .analyses = static_cast<int>(tasks.size()) - setup_.checkpoints().first_analysis(),
                  .version = CATENA_VERSION,
                  .parameters = outcome_.parameters,
                  .set = options_.set,
                  .units = setup_.scene().units});
  const auto first = static_cast<std::size_t>(setup_.checkpoints().first_analysis());
  for (std::size_t k = first; k < tasks.size(); ++k) {
    const AnalysisTask& task = tasks[k];
    if (k > first && outcome_.analyses.back().report.status == Status::cancelled) break;
    if (task.from_initial) {
      state = {};
      inexact_ = false;
      at_ends_.clear();
    } else if (k > first && !outcome_.analyses.back().report.ok()) {
      break;  // there is no state to go on from
    }
    ColumnExtremes rows(sink.begin_analysis(task.type()));
    outcome_.analyses.push_back(run_task(task, static_cast<int>(k), state, rows));
    std::vector<std::string>& warnings = outcome_.analyses.back().report.warnings;
    if (k == first) warnings.insert(warnings.begin(), setup_.scene().notes.begin(), setup_.scene().notes.end());
    outcome_.analyses.back().extremes = rows.extremes();
    outcome_.analyses.back().extremes_have_time = rows.timed();
    sink.end_analysis(outcome_.analyses.back());
    if (!outcome_.analyses.back().report.ok()) outcome_.exit_code = 1;
  }
  sink.end_run();
  if (!options_.save.empty()) save();
}

// The scene with the values that optimisations left behind; nothing where one of them failed.
void SceneRun::save() {
  if (outcome_.exit_code != 0) return;
  TextOutput file = TextOutput::file(options_.save);
  file.write(text_with_values(setup_.scene(), optimum_));
  if (!file.commit()) setup_.refuse(4, file.error());
}

}  // namespace

SceneOutcome run_scene(const std::string& path, const RunOptions& options, ResultSink& sink) {
  SceneOutcome outcome;
  SceneSetup setup(options, outcome);
  if (setup.read(path)) SceneRun(setup, options, outcome).run(sink);
  return outcome;
}

SceneOutcome check_scene(const std::string& path, const RunOptions& options) {
  SceneOutcome outcome;
  SceneSetup(options, outcome).read(path);
  return outcome;
}

}  // namespace catena
