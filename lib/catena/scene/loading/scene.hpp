// A scene in a C++ program: loaded once, run as often as wanted with other values of its parameters.
//
//   catena::Scene scene = catena::Scene::load("data/scenes/crank_rocker.json");
//   const catena::SceneResults results = scene.set("speed", 12).run();
//   const std::vector<double> angle = results["kinematics"].column("rocker.angle");
//
// Numbers are SI and radians. What is wrong with a text, a name or a value is thrown as SceneError or a standard
// exception that names it; how an analysis ended is a value (results.ok(), report().status).
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/results/result_storage.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena {

/// A scene that cannot be read, or a parameter that may not have a value: what() is what a compiler would print.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(const SceneOutcome& outcome)
      : std::runtime_error(outcome.error_text), diagnostics(outcome.errors) {}
  std::vector<Diagnostic> diagnostics;  ///< of the text, in its order; empty for files and values
};

/// What one analysis gave.
class AnalysisOutcome {
 public:
  AnalysisOutcome(AnalysisResult result, std::shared_ptr<const ResultStorage> rows)
      : result_(std::move(result)), rows_(std::move(rows)) {}

  const AnalysisResult& result() const { return result_; }  ///< fields, events, gradients
  const AnalysisReport& report() const { return result_.report; }
  bool ok() const { return report().ok(); }
  /// All rows; columns().size() values each. Every copy of the pointer keeps them alive.
  const std::shared_ptr<const ResultStorage>& rows() const { return rows_; }
  /// All values of a column. Throws std::out_of_range with the names that there are.
  std::vector<double> column(std::string_view name) const;
  /// A measure. Throws std::out_of_range for a name that is none, std::runtime_error with the reason where it has no
  /// value.
  double measure(std::string_view name) const;

 private:
  AnalysisResult result_;
  std::shared_ptr<const ResultStorage> rows_;
};

/// What a run gave, analysis by analysis.
class SceneResults {
 public:
  explicit SceneResults(std::vector<AnalysisOutcome> analyses) : analyses_(std::move(analyses)) {}

  bool ok() const;  ///< of all of them
  std::size_t size() const { return analyses_.size(); }
  auto begin() const { return analyses_.begin(); }
  auto end() const { return analyses_.end(); }
  /// By their place in the list, or the first of a type. Throws std::out_of_range.
  const AnalysisOutcome& operator[](std::size_t number) const;
  const AnalysisOutcome& operator[](std::string_view type) const;

 private:
  std::vector<AnalysisOutcome> analyses_;
};

class Scene {
 public:
  /// Reads and checks a file. Throws SceneError.
  static Scene load(const std::string& path);
  /// Reads and checks a text; `path` stands for it in messages, and files that it names are sought beside it.
  static Scene loads(std::string text, std::string path = "scene");

  /// Names and values of the parameters as the text has them.
  const std::vector<std::pair<std::string, double>>& parameters() const { return parameters_; }
  /// Gives a parameter a value for all further runs. Throws std::out_of_range for a name that is none,
  /// std::invalid_argument for a value that is not a number.
  Scene& set(std::string_view name, double value);
  /// The same in the syntax of scenes: "30 deg", "=2*a". What is wrong with it shows in run().
  Scene& set(std::string_view name, std::string_view value);

  /// Runs the analyses that the scene lists. `options.set` comes after the values given by set(). Throws SceneError
  /// where the scene allows no such values.
  SceneResults run(RunOptions options = {}) const;

 private:
  Scene(std::string path, std::string text);

  std::string path_, text_;
  std::vector<std::pair<std::string, double>> parameters_;
  std::vector<std::pair<std::string, std::string>> set_;
};

}  // namespace catena
