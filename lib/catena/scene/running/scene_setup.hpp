// A scene ready to run: read, with the parameters and analyses of the command line, built, checked, and with the files
// that the run goes on from or writes to.
//
// What is wrong is said in the outcome, with the exit code of its kind: 2 for the command line, 3 for the scene, 4 for
// files.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catena/scene/models/command_text.hpp"
#include "catena/scene/models/scene_models.hpp"
#include "catena/scene/models/sweep_record.hpp"
#include "catena/scene/reading/analysis_task.hpp"
#include "catena/scene/running/scene_checkpoints.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena {

class SceneSetup {
 public:
  /// Both must outlive this object.
  SceneSetup(const RunOptions& options, SceneOutcome& outcome) : options_(options), outcome_(outcome) {}

  /// Reads and checks everything; false if anything is wrong. The other functions want this one to have succeeded.
  bool read(const std::string& path);
  /// Ends with this exit code.
  void refuse(int exit_code, const std::string& why);

  const SceneTemplate& scene() const { return *scene_; }
  const ParameterNames& parameter_names() const { return parameters_.names(); }
  const std::vector<AnalysisTask>& tasks() const { return tasks_; }
  const std::shared_ptr<const Model>& model() const { return model_; }
  /// The model at the task's values of the parameters.
  std::shared_ptr<const Model> model_for(const AnalysisTask& task) {
    return task.changes_parameters ? build(task.parameters) : model_;
  }
  const SceneModels& models() const { return *models_; }
  const SceneCheckpoints& checkpoints() const { return checkpoints_; }
  SweepRecord* record() { return record_ ? &*record_ : nullptr; }
  /// Hash of what the designs of sweeps depend on.
  const std::string& sweep_owner() const { return sweep_owner_; }

  using NamedValues = std::vector<std::pair<std::string, double>>;
  /// The values of the scene and its command line.
  NamedValues given_parameters() { return named(parameters_.evaluate<double>(scene_->expressions, diagnostics_)); }
  NamedValues named(std::span<const double> values) const;

 private:
  bool prepare(SourceText source);
  std::vector<std::string> asked_outputs() const;
  void read_tasks();
  void check_task(const AnalysisTask& task);
  std::shared_ptr<const Model> build(std::span<const double> parameters);
  void finish_errors();
  bool has_task(std::string_view type) const;
  /// Whether what the options say of dynamics can be done.
  bool check_dynamics_options();
  bool prepare_files();

  const RunOptions& options_;
  SceneOutcome& outcome_;
  Diagnostics diagnostics_;
  CommandText command_;
  std::unique_ptr<SceneTemplate> scene_;
  ParameterTable parameters_;
  std::shared_ptr<const Model> model_;
  std::vector<AnalysisTask> tasks_;
  std::optional<SceneModels> models_;
  SceneCheckpoints checkpoints_{options_};
  std::string sweep_owner_;
  std::optional<SweepRecord> record_;
};

}  // namespace catena
