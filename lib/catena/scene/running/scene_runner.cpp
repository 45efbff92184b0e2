#include "catena/scene/running/scene_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "catena/analysis/batch/lane_kernels.hpp"
#include "catena/analysis/design/process_link.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/judging/scene_checks.hpp"
#include "catena/scene/models/command_text.hpp"
#include "catena/scene/models/given_designs.hpp"
#include "catena/scene/models/scene_models.hpp"
#include "catena/scene/models/scene_saving.hpp"
#include "catena/scene/models/sweep_record.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "catena/scene/reading/scene_reading.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/own_names.hpp"
#include "catena/scene/running/scene_checkpoints.hpp"

namespace catena {
namespace {

/// `four_bar` of `scenes/four_bar.json`.
std::string stem(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::size_t dot = name.find_last_of('.');
  return dot == std::string::npos || dot == 0 ? name : name.substr(0, dot);
}

void print_iteration(std::string_view method, int iteration, double residual, double change) {
  const std::string line = fmt::format("{} {}: residual {:.3g}, change {:.3g}\n", method, iteration, residual, change);
  std::fputs(line.c_str(), stderr);
}

class SceneRun {
 public:
  SceneRun(const RunOptions& options, SceneOutcome& outcome) : options_(options), outcome_(outcome) {}

  /// Reads and checks everything; what is wrong is in the outcome.
  bool read(const std::string& path);
  void run(ResultSink& sink);

 private:
  /// Reads and checks everything; false if anything is wrong.
  bool prepare(SourceText source);
  std::vector<std::string> asked_outputs() const;
  void read_tasks();
  void check_task(const AnalysisTask& task);
  std::shared_ptr<const Model> build(std::span<const double> parameters);
  void save();
  /// The task with the parameters that earlier paths left behind, unless it sets them itself.
  AnalysisTask with_handed_on(AnalysisTask task, std::optional<std::string>& why_not);
  ParameterSeeds handed_on_to(const AnalysisTask& task) const;
  AnalysisResult run_task(const AnalysisTask& read, int number, SystemState& state, RowSink& rows);
  std::vector<std::pair<std::string, double>> named_parameters(std::span<const double> values) const;
  void finish_errors();
  /// Whether what the options say of dynamics can be done.
  bool check_dynamics_options();
  bool prepare_files();
  void refuse(int exit_code, const std::string& why);

  const RunOptions& options_;
  SceneOutcome& outcome_;
  Diagnostics diagnostics_;
  CommandText command_;
  std::unique_ptr<SceneTemplate> scene_;
  ParameterTable parameters_;
  std::shared_ptr<const Model> model_;
  std::vector<AnalysisTask> tasks_;
  std::optional<SceneModels> models_;
  ParameterSeeds handed_on_;  // values of parameters that paths and optimisations left behind
  SceneCheckpoints checkpoints_{options_};
  std::string sweep_owner_;  // hash of what the designs of sweeps depend on
  std::optional<SweepRecord> record_;
};

std::shared_ptr<const Model> SceneRun::build(std::span<const double> parameters) {
  return std::make_shared<Model>(build_model<double>(*scene_, parameters, {options_.max_elements}, diagnostics_));
}

void SceneRun::check_task(const AnalysisTask& task) {
  std::shared_ptr<const Model> model = model_;
  if (task.changes_parameters) {
    model = build(task.parameters);
    if (!diagnostics_.ok()) return;
  }
  SceneChecks(*scene_, *model, diagnostics_).check_task(task);
  for (const AnalysisTask& inner : task.of) check_task(inner);
}

// The outputs that the caller names: what analyses have by themselves is left to them, and a derivative stands for the
// column that it is of.
std::vector<std::string> SceneRun::asked_outputs() const {
  std::vector<std::string> asked;
  for (std::string name : options_.outputs) {
    bool own = false;
    for (const AnalysisTask& task : tasks_) {
      own = own || has_by_itself(task, name, parameters_.names());
      if (std::optional<std::string> column = differentiated(task, name, parameters_.names()))
        name = std::move(*column);
    }
    if (!own && std::find(asked.begin(), asked.end(), name) == asked.end()) asked.push_back(std::move(name));
  }
  return asked;
}

void SceneRun::read_tasks() {
  SceneTemplate& scene = *scene_;
  const std::vector<double> values = parameters_.evaluate<double>(scene.expressions, diagnostics_);
  if (scene.outputs) read_outputs(scene.outputs, scene, values, diagnostics_);
  if (scene.analyses) tasks_ = read_analyses(scene.analyses, scene.outputs, scene, parameters_, diagnostics_);
  if (command_.read_outputs(asked_outputs(), diagnostics_)) {
    const std::vector<PlacedName> outputs = read_outputs(command_.outputs(), scene, values, diagnostics_);
    for (AnalysisTask& task : tasks_) {
      if (task.description->find("outputs")) task.outputs = outputs;
    }
  }
  if (!options_.only.empty()) std::erase_if(tasks_, [&](const auto& task) { return task.type() != options_.only; });
  if (options_.verb.empty()) return;
  // The scene's own analyses were checked, but one from the command line is run in their place.
  tasks_.clear();
  if (!command_.read_verb(options_.verb, options_.verb_options, diagnostics_)) return;
  if (auto task = read_analysis(command_.verb(), scene.outputs, scene, parameters_, diagnostics_))
    tasks_.push_back(std::move(*task));
}

bool SceneRun::prepare(SourceText source) {
  scene_ = read_scene(std::move(source), diagnostics_);
  if (!scene_ || scene_->may_lack_parts) return false;
  parameters_ = scene_->parameters;
  if (command_.read_set(options_.set, diagnostics_)) parameters_.set(command_.set(), scene_->expressions, diagnostics_);
  models_.emplace(*scene_, options_.max_elements);
  const std::vector<double> values = parameters_.evaluate<double>(scene_->expressions, diagnostics_);
  const bool scene_is_sound = diagnostics_.ok();
  read_tasks();  // first: expressions in them become columns of the model
  const std::size_t errors = diagnostics_.count();
  model_ = build(values);
  if (scene_is_sound && diagnostics_.count() == errors) {
    SceneChecks checks(*scene_, *model_, diagnostics_);
    checks.check_own_columns();
    for (const AnalysisTask& task : tasks_) check_task(task);
    if (scene_->outputs && tasks_.empty())
      checks.check_columns(read_outputs(scene_->outputs, *scene_, values, diagnostics_));
  }
  return diagnostics_.ok();
}

// Errors in what came from the command line are the caller's, not the scene's.
void SceneRun::finish_errors() {
  bool in_scene = false;
  std::string command_errors;
  for (const Diagnostic& error : diagnostics_.items()) {
    if (CommandText::is_command(error)) {
      command_errors += fmt::format("catena: {}: {}\n", command_.option_of(error), error.message);
    } else {
      in_scene = true;
    }
  }
  if (in_scene) {
    outcome_.exit_code = 3;
    outcome_.error_text = diagnostics_.text();
    outcome_.errors = diagnostics_.in_order();
  } else {
    outcome_.exit_code = 2;
    outcome_.error_text = command_errors;
  }
}

ParameterSeeds SceneRun::handed_on_to(const AnalysisTask& task) const {
  ParameterSeeds seeds;
  for (const ParameterSeed<double>& seed : handed_on_) {
    const std::vector<int>& set = task.set_parameters;
    if (std::find(set.begin(), set.end(), seed.index) == set.end()) seeds.push_back(seed);
  }
  return seeds;
}

AnalysisTask SceneRun::with_handed_on(AnalysisTask task, std::optional<std::string>& why_not) {
  const ParameterSeeds seeds = handed_on_to(task);
  if (seeds.empty()) return task;
  why_not = models_->set_parameters(task, seeds);
  task.changes_parameters = true;
  return task;
}

std::vector<std::pair<std::string, double>> SceneRun::named_parameters(std::span<const double> values) const {
  std::vector<std::pair<std::string, double>> named;
  const auto& names = parameters_.names().all();
  for (std::size_t k = 0; k < names.size() && k < values.size(); ++k) named.emplace_back(names[k], values[k]);
  return named;
}

AnalysisResult SceneRun::run_task(const AnalysisTask& read, int number, SystemState& state, RowSink& rows) {
  AnalysisResult result;
  std::optional<std::string> unfit;
  const AnalysisTask task = with_handed_on(read, unfit);
  result.type = task.type();
  const AnalysisFunction function = analysis_function(task.type());
  const auto is_path = [](const AnalysisTask& earlier) { return earlier.type() == "path"; };
  if (number == checkpoints_.first_analysis() && !read.from_initial &&
      std::any_of(tasks_.begin(), tasks_.begin() + number, is_path)) {
    result.report.status = Status::refused;
    result.report.message =
        "a checkpoint does not keep the parameter that a path before it ended with: run the whole scene";
    return result;
  }
  if (unfit) {
    result.report.status = Status::refused;
    result.report.message = fmt::format("with the parameters that the path before left behind: {}", *unfit);
    return result;
  }
  CheckpointRequest checkpoint = checkpoints_.request(number);
  AnalysisContext context{.task = task,
                          .model = task.changes_parameters ? build(task.parameters) : model_,
                          .state = state,
                          .rows = rows,
                          .cancel = options_.cancel,
                          .progress = {},
                          .verbose = options_.verbose,
                          .trace = options_.verbose ? IterationTrace(print_iteration) : IterationTrace(),
                          .models = &*models_,
                          .seeds = handed_on_to(read),
                          .parameter_name = {},
                          .estimate_error = options_.estimate_error,
                          .checkpoint = checkpoints_.wanted() ? &checkpoint : nullptr,
                          .poses = options_.poses,
                          .digits = true,
                          .threads = options_.threads,
                          .sweep = {.record = record_ ? &*record_ : nullptr,
                                    .link = options_.link,
                                    .patience = options_.patience,
                                    .owner = sweep_owner_,
                                    .analysis = number + 1}};
  if (context.poses) context.poses->begin_poses(context.model);
  if (task.changes_parameters) {
    // Those that follow from what was set differ too.
    const auto before = named_parameters(parameters_.evaluate<double>(scene_->expressions, diagnostics_));
    const auto own = named_parameters(task.parameters);
    const JsonValue set = task.place.find("set");
    for (std::size_t k = 0; k < own.size(); ++k) {
      if ((set && set.find(own[k].first)) || own[k].second != before[k].second) result.set.push_back(own[k]);
    }
  }
  if (task.has("parameter"))
    context.parameter_name = parameters_.names().all()[static_cast<std::size_t>(task.word("parameter"))];
  if (options_.progress) {
    context.progress = [&, number](double fraction) {
      options_.progress({task.type(), number, static_cast<int>(tasks_.size()), fraction});
    };
  }
  try {
    function(context, result);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    result.report.status = Status::refused;
    result.report.message = error.what();
  }
  for (const ParameterSeed<double>& value : context.values_at_end) {
    std::erase_if(handed_on_, [&](const auto& seed) { return seed.index == value.index; });
    handed_on_.push_back(value);
  }
  return result;
}

void SceneRun::run(ResultSink& sink) {
  SystemState state;
  if (options_.poses) options_.poses->begin_poses(model_);
  sink.begin_run({.scene = outcome_.scene,
                  .description = std::string(scene_->description),
                  .gravity = {model_->gravity.x, model_->gravity.y},
                  .bodies = static_cast<int>(model_->bodies.size()),
                  .elements = static_cast<int>(model_->elements.size()),
                  .analyses = static_cast<int>(tasks_.size()) - checkpoints_.first_analysis(),
                  .version = CATENA_VERSION,
                  .parameters = outcome_.parameters,
                  .set = options_.set,
                  .units = scene_->units});
  const auto first = static_cast<std::size_t>(checkpoints_.first_analysis());
  for (std::size_t k = first; k < tasks_.size(); ++k) {
    const AnalysisTask& task = tasks_[k];
    if (k > first && outcome_.analyses.back().report.status == Status::cancelled) break;
    if (task.from_initial) {
      state = {};
      handed_on_.clear();
    } else if (k > first && !outcome_.analyses.back().report.ok()) {
      break;  // there is no state to go on from
    }
    ColumnExtremes rows(sink.begin_analysis(task.type()));
    outcome_.analyses.push_back(run_task(task, static_cast<int>(k), state, rows));
    std::vector<std::string>& warnings = outcome_.analyses.back().report.warnings;
    if (k == first) warnings.insert(warnings.begin(), scene_->notes.begin(), scene_->notes.end());
    outcome_.analyses.back().extremes = rows.extremes();
    outcome_.analyses.back().extremes_have_time = rows.timed();
    sink.end_analysis(outcome_.analyses.back());
    if (!outcome_.analyses.back().report.ok()) outcome_.exit_code = 1;
  }
  sink.end_run();
  if (!options_.save.empty()) save();
}

void SceneRun::refuse(int exit_code, const std::string& why) {
  outcome_.exit_code = exit_code;
  outcome_.error_text = fmt::format("catena: {}\n", why);
}

bool SceneRun::check_dynamics_options() {
  if (!(options_.checkpoint_every >= 0) || !std::isfinite(options_.checkpoint_every)) {
    refuse(2, "--checkpoint-every: wants seconds above zero");
    return false;
  }
  const bool any =
      std::any_of(tasks_.begin(), tasks_.end(), [](const auto& task) { return task.type() == "dynamics"; });
  if (any) return true;
  if (options_.estimate_error) {
    refuse(2, "--estimate-error: the scene has no dynamics analysis, and others have no error of integration");
  } else if (!options_.checkpoint.empty()) {
    refuse(2, "--checkpoint: the scene has no dynamics analysis, and others have nothing to be saved on the way");
  }
  return outcome_.exit_code == 0;
}

// The files to go on from and to write to: with all that the scene was read from, they know their own again.
bool SceneRun::prepare_files() {
  std::vector<std::string_view> texts{scene_->source->text()};
  for (const auto& file : scene_->data_files) texts.push_back(file->text());
  try {
    checkpoints_.prepare(texts);
    texts.push_back(CATENA_VERSION);
    for (const auto& [name, value] : options_.set) texts.insert(texts.end(), {name, value});
    // Another command analyses other designs; lanes, and each kind of them, round otherwise.
    texts.insert(texts.end(), {options_.only, lane_kernels().name, options_.poses ? "drawn" : ""});
    sweep_owner_ = fingerprint(texts);
    // Only the process that leads others keeps a record.
    const bool keeps = !options_.record.empty() && !(options_.link && options_.link->rank() > 0);
    const bool any = std::any_of(tasks_.begin(), tasks_.end(), [](const auto& task) { return task.type() == "sweep"; });
    if (keeps && !any) {
      refuse(2, "--record: the scene has no sweep, and other analyses have no designs to be kept");
      return false;
    }
    if (keeps) record_.emplace(options_.record, outcome_.scene, sweep_owner_, options_.resume);
  } catch (const CheckpointError& error) {
    refuse(4, error.what());
    return false;
  } catch (const SweepRecordError& error) {
    refuse(4, error.what());
    return false;
  }
  return true;
}

bool SceneRun::read(const std::string& path) {
  outcome_.scene = stem(path);
  std::optional<SourceText> source;
  try {
    source.emplace(options_.text ? SourceText(path, *options_.text) : SourceText::read(path));
  } catch (const FileError& error) {
    refuse(4, error.what());
    return false;
  }
  if (!prepare(std::move(*source))) {
    finish_errors();
    return false;
  }
  if (!scene_->name.empty()) outcome_.scene = scene_->name;
  if (!check_dynamics_options()) return false;
  if (tasks_.empty() && !options_.only.empty()) {
    refuse(2, fmt::format("the scene lists no {} in its analyses", options_.only));
    return false;
  }
  if (const auto why = why_no_outputs(tasks_, options_.outputs, parameters_.names())) {
    refuse(2, *why);
    return false;
  }
  if (options_.designs) {
    if (const std::optional<std::string> why =
            sweep_over_given(options_.designs->names, options_.designs->values, parameters_, tasks_)) {
      refuse(2, *why);
      return false;
    }
  }
  if (!prepare_files()) return false;
  outcome_.parameters = named_parameters(parameters_.evaluate<double>(scene_->expressions, diagnostics_));
  return true;
}

// The scene with the values that optimisations left behind; nothing where one of them failed.
void SceneRun::save() {
  if (outcome_.exit_code != 0) return;
  TextOutput file = TextOutput::file(options_.save);
  file.write(text_with_values(*scene_, handed_on_));
  if (!file.commit()) refuse(4, file.error());
}

}  // namespace

SceneOutcome run_scene(const std::string& path, const RunOptions& options, ResultSink& sink) {
  SceneOutcome outcome;
  SceneRun run(options, outcome);
  if (run.read(path)) run.run(sink);
  return outcome;
}

SceneOutcome check_scene(const std::string& path, const RunOptions& options) {
  SceneOutcome outcome;
  SceneRun(options, outcome).read(path);
  return outcome;
}

}  // namespace catena
