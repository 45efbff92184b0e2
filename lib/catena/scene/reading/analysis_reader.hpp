// Reads one analysis of a scene into a task, by the description of its type.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/scene/numbers/evaluation.hpp"
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
  /// The scene's tables at the parameters of the analysis that is read.
  std::vector<Formula<double>::Table> tables() const { return parameters_.tables<double>(scene_.expressions, values_); }
  const AnalysisDescription* read_type(const JsonValue& object);
  void read_key(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task);
  void read_times(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task);
  int read_parameter(const JsonValue& value, const FieldName& field);
  void read_parameter_key(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task);
  double number(const AnalysisKey& key, const JsonValue& value, const FieldName& field, TaskNumber place);
  double evaluated(const NumberValue& read, const JsonValue& value, TaskNumber place);
  void read_parameters(const JsonValue& set, AnalysisTask& task);
  /// With the variables of the blocks that are being read.
  Evaluation<double> evaluation(const JsonValue& value) const;
  // event_reader.cpp
  void read_events(const JsonValue& list, AnalysisTask& task);
  void read_event_blocks(const JsonValue& list, AnalysisTask& task);
  void read_event_block(const JsonValue& object, AnalysisTask& task);
  void repeat_events(std::int64_t first, std::int64_t count, const JsonValue& events, const JsonValue& blocks,
                     AnalysisTask& task);
  std::optional<std::int64_t> whole_number(const AnalysisKey& key, const JsonValue& value);
  std::string event_text(const JsonValue& value, const FieldName& field);
  // measure_reader.cpp
  void read_measures(const JsonValue& object, AnalysisTask& task);
  void read_measure(const JsonMember& member, AnalysisTask& task);
  std::optional<std::size_t> measure_kind(const JsonMember& member);
  void read_path(const JsonValue& object, std::size_t number, PlacedMeasure& measure);
  bool read_measured_column(const JsonValue& value, PlacedMeasure& measure);
  void read_field_name(const JsonValue& value, PlacedMeasure& measure);
  // design_reader.cpp
  void read_inner_analyses(const JsonValue& value, AnalysisTask& task);
  void read_parameter_names(const JsonValue& list, AnalysisTask& task);
  void read_variables(const JsonValue& object, AnalysisTask& task);
  void read_variable(const JsonMember& member, AnalysisTask& task);
  bool read_formula(const JsonValue& value, std::size_t from, std::size_t to, const AnalysisTask& task,
                    DesignFormula& formula);
  void read_objective(const JsonValue& value, AnalysisTask& task);
  void read_relations(const JsonValue& list, AnalysisTask& task);
  void read_relation(const JsonValue& value, AnalysisTask& task);
  void check_design(const JsonValue& object, const AnalysisTask& task);
  void check_field(const JsonValue& value, std::string_view field, const AnalysisDescription& own);
  /// Whether a measure or a variable is in a formula, or what follows from a variable.
  bool varies(const DesignFormula& formula, const AnalysisTask& task) const;
  // sweep_reader.cpp
  void read_over(const JsonValue& object, AnalysisTask& task);
  void read_range(const JsonMember& member, AnalysisTask& task);
  void read_steps(const JsonMember& member, const std::array<JsonValue, 3>& v, const std::string& owner,
                  SweepRange& range);
  void check_sweep(const JsonValue& object, AnalysisTask& task);
  void read_event(const JsonValue& object, AnalysisTask& task);
  EventRequest::Impulse read_impulse(const JsonValue& object, std::size_t event);
  /// What a method of dynamics wants.
  void check_method(const JsonValue& object, const AnalysisTask& task);
  void check_times(const std::vector<JsonValue>& values, const AnalysisTask& task);
  void error(const JsonValue& value, std::string message) { report(value, std::move(message), diagnostics_); }

  SceneTemplate& scene_;
  const ParameterTable& parameters_;
  Diagnostics& diagnostics_;
  SceneReading reading_;
  std::span<const double> values_;       // of the parameters, for the analysis that is read
  std::vector<TaskNumber> varying_;      // of that analysis
  std::vector<std::string> loop_names_;  // of the blocks around what is read, outermost first
  std::vector<double> loop_values_;
  ExpectedDimension dimension_of_parameter_;  // of the one that the analysis changes, where it is known
  JsonValue scene_outputs_;
};

}  // namespace catena
