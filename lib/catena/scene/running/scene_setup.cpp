#include "catena/scene/running/scene_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/batch/kernels/lane_kernels.hpp"
#include "catena/analysis/design/process_link.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/judging/scene_checks.hpp"
#include "catena/scene/models/given_designs.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "catena/scene/reading/scene_reading.hpp"
#include "catena/scene/running/own_names.hpp"

namespace catena {
namespace {

/// `four_bar` of `scenes/four_bar.json`.
std::string stem(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::size_t dot = name.find_last_of('.');
  return dot == std::string::npos || dot == 0 ? name : name.substr(0, dot);
}

}  // namespace

std::shared_ptr<const Model> SceneSetup::build(std::span<const double> parameters) {
  return std::make_shared<Model>(build_model<double>(*scene_, parameters, {options_.max_elements}, diagnostics_));
}

void SceneSetup::check_task(const AnalysisTask& task) {
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
std::vector<std::string> SceneSetup::asked_outputs() const {
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

void SceneSetup::read_tasks() {
  SceneTemplate& scene = *scene_;
  const std::vector<double> values = parameters_.evaluate<double>(scene.expressions, diagnostics_);
  if (scene.outputs) read_outputs(scene.outputs, scene, values, diagnostics_);
  if (scene.analyses) tasks_ = read_analyses(scene.analyses, scene.outputs, scene, parameters_, diagnostics_);
  if (command_.read_outputs(asked_outputs(), diagnostics_)) {
    const std::vector<PlacedName> outputs = read_outputs(command_.outputs(), scene, values, diagnostics_);
    for (AnalysisTask& task : tasks_) {
      // A sensitivity has the columns of the analysis inside of it; a wrong one may have none.
      AnalysisTask& with_rows = task.type() == "sensitivity" && !task.of.empty() ? task.of.front() : task;
      if (with_rows.description->find("outputs")) with_rows.outputs = outputs;
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

bool SceneSetup::prepare(SourceText source) {
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
void SceneSetup::finish_errors() {
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

SceneSetup::NamedValues SceneSetup::named(std::span<const double> values) const {
  NamedValues named;
  const auto& names = parameters_.names().all();
  for (std::size_t k = 0; k < names.size() && k < values.size(); ++k) named.emplace_back(names[k], values[k]);
  return named;
}

void SceneSetup::refuse(int exit_code, const std::string& why) {
  outcome_.exit_code = exit_code;
  outcome_.error_text = fmt::format("catena: {}\n", why);
}

bool SceneSetup::has_task(std::string_view type) const {
  return std::any_of(tasks_.begin(), tasks_.end(), [&](const AnalysisTask& task) { return task.type() == type; });
}

bool SceneSetup::check_dynamics_options() {
  if (!(options_.checkpoint_every >= 0) || !std::isfinite(options_.checkpoint_every)) {
    refuse(2, "--checkpoint-every: wants seconds above zero");
    return false;
  }
  if (has_task("dynamics")) return true;
  if (options_.estimate_error) {
    refuse(2, "--estimate-error: the scene has no dynamics analysis, and others have no error of integration");
  } else if (!options_.checkpoint.empty()) {
    refuse(2, "--checkpoint: the scene has no dynamics analysis, and others have nothing to be saved on the way");
  }
  return outcome_.exit_code == 0;
}

// The files to go on from and to write to: with all that the scene was read from, they know their own again.
bool SceneSetup::prepare_files() {
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
    if (keeps && !has_task("sweep")) {
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

bool SceneSetup::read(const std::string& path) {
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
  outcome_.parameters = given_parameters();
  return true;
}

}  // namespace catena
