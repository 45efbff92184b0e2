// A scene that stays open: read once, it gives models for any values of its parameters.
//
// Columns are chosen when it is opened, since expressions among them become part of the models. Errors throw
// SceneError.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "catena/model/model.hpp"
#include "catena/scene/models/command_text.hpp"
#include "catena/scene/models/scene_models.hpp"

namespace catena::python {

class OpenScene {
 public:
  /// `set` is in the syntax of scenes; without `outputs` the columns are those that the scene names.
  OpenScene(const std::string& path, const std::optional<std::string>& text, const Texts& set,
            const std::vector<std::string>& outputs);

  std::span<const std::string> outputs() const { return outputs_; }
  /// Values of all parameters, in the order of the scene.
  std::vector<std::pair<std::string, double>> parameters() const;
  std::shared_ptr<const Model> model() const;
  /// Changes parameters, SI. Where the scene allows no such values nothing is changed.
  void set(const std::map<std::string, double>& values);
  /// What set() changed so far; to be put back.
  const ParameterSeeds& changes() const { return seeds_; }
  void put_back(ParameterSeeds changes) { seeds_ = std::move(changes); }

 private:
  /// Throws what was reported.
  void check(const Diagnostics& diagnostics) const;

  std::unique_ptr<SceneTemplate> scene_;
  CommandText command_;
  ParameterTable table_;
  std::optional<SceneModels> models_;
  ParameterSeeds seeds_;
  std::vector<std::string> outputs_;
};

/// Errors of options with the names that arguments have in Python.
std::string in_python_words(std::string text);

/// Throws SceneError, with what may be meant, for the first name that is no parameter of the scene; and where its text
/// cannot be read.
void check_names(const std::string& path, const std::optional<std::string>& text,
                 const std::vector<std::string>& names);

}  // namespace catena::python
