// Reads one analysis of a scene into a task, by the description of its type.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/scene/reading/analysis_task.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {

class AnalysisReader {
 public:
  AnalysisReader(SceneTemplate& scene, const ParameterTable& parameters, Diagnostics& diagnostics)
      : scene_(scene), parameters_(parameters), diagnostics_(diagnostics), reading_(scene, diagnostics) {}

  std::optional<AnalysisTask> read(const JsonValue& object, const JsonValue& scene_outputs);
  std::vector<PlacedName> names(const JsonValue& list, const FieldName& field, std::span<const double> parameters);

 private:
  const AnalysisDescription* read_type(const JsonValue& object);
  void read_key(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task);
  double number(const AnalysisKey& key, const JsonValue& value, const FieldName& field);
  void read_parameters(const JsonValue& set, AnalysisTask& task);
  void read_events(const JsonValue& list, AnalysisTask& task);
  void read_event(const JsonValue& object, AnalysisTask& task);
  void check_times(const std::vector<JsonValue>& values, const AnalysisTask& task);
  void error(const JsonValue& value, std::string message) { report(value, std::move(message), diagnostics_); }

  SceneTemplate& scene_;
  const ParameterTable& parameters_;
  Diagnostics& diagnostics_;
  SceneReading reading_;
  std::span<const double> values_;  // of the parameters, for the analysis that is read
};

}  // namespace catena
