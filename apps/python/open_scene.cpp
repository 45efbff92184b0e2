#include "open_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "catena/scene/building/build_model.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/judging/scene_checks.hpp"
#include "catena/scene/reading/analysis_task.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena::python {
namespace {

constexpr std::int64_t max_elements = BuildOptions{}.max_elements;

[[noreturn]] void throw_unknown(const std::string& name, const ParameterNames& names) {
  throw SceneError(
      "catena: there is no parameter " + in_quotes(name) + NearMiss(name).consider_all(names.all()).hint() + "\n", {});
}

SourceText source_of(const std::string& path, const std::optional<std::string>& text) {
  try {
    return text ? SourceText(path, *text) : SourceText::read(path);
  } catch (const FileError& error) {
    throw SceneError(error.what(), {});
  }
}

}  // namespace

std::string in_python_words(std::string text) {
  constexpr std::pair<std::string_view, std::string_view> words[] = {{"catena: --set: ", "catena: parameters: "},
                                                                     {"catena: --outputs: ", "catena: outputs: "}};
  for (const auto& [option, argument] : words) {
    for (std::size_t at = 0; (at = text.find(option, at)) != std::string::npos; at += argument.size()) {
      if (at == 0 || text[at - 1] == '\n') text.replace(at, option.size(), argument);
    }
  }
  return text;
}

OpenScene::OpenScene(const std::string& path, const std::optional<std::string>& text, const Texts& set,
                     const std::vector<std::string>& outputs) {
  Diagnostics diagnostics;
  scene_ = read_scene(source_of(path, text), diagnostics);
  check(diagnostics);
  table_ = scene_->parameters;
  if (command_.read_set(set, diagnostics)) table_.set(command_.set(), scene_->expressions, diagnostics);
  const std::vector<double> values = table_.evaluate<double>(scene_->expressions, diagnostics);
  JsonValue list = scene_->outputs;
  if (command_.read_outputs(outputs, diagnostics)) list = command_.outputs();
  check(diagnostics);
  std::vector<PlacedName> names;
  if (list) names = read_outputs(list, *scene_, values, diagnostics);
  const Model built = build_model<double>(*scene_, values, {max_elements}, diagnostics);
  check(diagnostics);
  SceneChecks checks(*scene_, built, diagnostics);
  checks.check_columns(names);
  checks.check_own_columns();
  for (const PlacedName& placed : names) outputs_.push_back(placed.name);
  check(diagnostics);
  models_.emplace(*scene_, max_elements);
}

void OpenScene::check(const Diagnostics& diagnostics) const {
  if (diagnostics.ok() && scene_) return;
  std::string text;
  for (const Diagnostic& error : diagnostics.items()) {
    if (!CommandText::is_command(error)) throw SceneError(diagnostics.text(), diagnostics.in_order());
    text += "catena: " + command_.option_of(error) + ": " + error.message + "\n";
  }
  throw SceneError(in_python_words(text), {});
}

std::vector<std::pair<std::string, double>> OpenScene::parameters() const {
  std::vector<std::pair<std::string, double>> named;
  const std::vector<double> values = models_->values(table_, seeds_);
  const std::span<const std::string> names = models_->names().all();
  for (std::size_t k = 0; k < values.size(); ++k) named.emplace_back(names[k], values[k]);
  return named;
}

std::shared_ptr<const Model> OpenScene::model() const {
  std::string why;
  std::shared_ptr<const Model> model = models_->model(table_, seeds_, &why);
  if (!model) throw SceneError("catena: with these parameters there is no model: " + why + "\n", {});
  return model;
}

void OpenScene::set(const std::map<std::string, double>& values) {
  ParameterSeeds seeds = seeds_;
  for (const auto& [name, value] : values) {
    const int index = models_->names().find(name);
    if (index < 0) throw_unknown(name, models_->names());
    if (!std::isfinite(value))
      throw SceneError("catena: parameter " + in_quotes(name) + " must be a finite number\n", {});
    std::erase_if(seeds, [&](const auto& seed) { return seed.index == index; });
    seeds.push_back({index, value});
  }
  std::string why;
  if (models_->values(table_, seeds, &why).empty() && models_->names().size() > 0)
    throw SceneError("catena: " + why + "\n", {});
  seeds_ = std::move(seeds);
}

void check_names(const std::string& path, const std::optional<std::string>& text,
                 const std::vector<std::string>& names) {
  Diagnostics diagnostics;
  const std::unique_ptr<SceneTemplate> scene = read_scene(source_of(path, text), diagnostics);
  if (!scene) throw SceneError(diagnostics.text(), diagnostics.in_order());
  for (const std::string& name : names) {
    if (scene->parameters.names().find(name) < 0) throw_unknown(name, scene->parameters.names());
  }
}

}  // namespace catena::python
