// One analysis of a scene, read: its keys as values, ready to be run.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catena/analysis/design/sweep_plan.hpp"
#include "catena/analysis/measures/measure.hpp"
#include "catena/scene/describing/analysis_description.hpp"
#include "catena/scene/reading/scene_template.hpp"

namespace catena {

struct EventRequest {
  std::string name, column;
  double value = 0;
  std::optional<Dimension> value_dimension;  ///< of a quantity, or of a parameter that has one
  int direction = 0;                         ///< position among the words of the key: any, up, down
  int action = 0;                            ///< record, stop, release, engage
  std::string element;
  JsonValue place, value_place, element_place;  ///< of the column; of the value; of the element
  /// An impulse, if the event has one: on a named point of a body, or on one in its own coordinates.
  struct Impulse {
    std::string body, point;
    std::array<double, 2> local{}, value{};
    JsonValue place;
  };
  std::optional<Impulse> impulse;
};

/// A name that an analysis uses, and where it stands.
struct PlacedName {
  std::string name;
  JsonValue place;
};

/// A measure, and where it and the columns that it names stand.
struct PlacedMeasure {
  MeasureRequest request;
  JsonValue place;
  std::vector<PlacedName> columns;
};

/// A number of an analysis that is not a constant, and where the task keeps its value.
struct TaskNumber {
  enum class Place : unsigned char {
    key,
    instant,
    event,
    struck_point,
    impulse,
    measured_instant,
    path_point,
    fixed  ///< kept nowhere: how often events are repeated
  };
  Place place = Place::key;
  NumberValue value{};
  const AnalysisKey* key = nullptr;   ///< of `key`, `instant`, `event`: what it may be
  std::size_t item = 0;               ///< number of the instant, the event, the measure
  std::size_t part = 0;               ///< of a pair, x or y; of path points, one pair after the other
  std::vector<double> loop_values{};  ///< of the blocks around it
  double as_read = 0;

  bool is_of_measure() const { return place == Place::measured_instant || place == Place::path_point; }
  /// `"until"`, `"to" of measure 2`.
  std::string name() const;
};

/// A parameter that an optimisation may change.
struct DesignVariable {
  int parameter = -1;
  double least = 0, greatest = 0, start = 0;
};

/// An expression over measures (its inputs, by number among the task's) and parameters.
struct DesignFormula {
  Expression expression;
  std::vector<int> measures;
};

/// A constraint: left - right is at most zero, or zero.
struct DesignRelation {
  std::string text;
  DesignFormula left, right;
  bool equality = false;
};

/// What an optimisation is to make of the analyses that it runs.
struct DesignGoal {
  std::vector<DesignVariable> variables;
  DesignFormula objective;
  bool maximise = false;
  std::vector<DesignRelation> relations;
};

struct AnalysisTask {
  const AnalysisDescription* description = nullptr;
  JsonValue place;  ///< the object
  bool from_initial = false;
  bool changes_parameters = false;
  std::vector<double> parameters;  ///< all of the scene's, with `set` applied
  std::vector<PlacedName> outputs;
  std::map<std::string_view, double> numbers;  ///< numbers, flags (0 or 1), positions of words and parameters
  std::optional<std::vector<double>> at;
  std::vector<EventRequest> events;
  std::vector<PlacedMeasure> measures;
  std::shared_ptr<const ParameterTable> table;  ///< the scene's parameters with `set` applied
  std::vector<int> set_parameters;              ///< those that `set` names
  std::vector<AnalysisTask> of;                 ///< the analyses that it differentiates or optimises
  std::vector<int> design_parameters;           ///< by which it differentiates
  std::vector<TaskNumber> varying;              ///< numbers that depend on parameters
  DesignGoal goal;
  SweepRequest sweep;

  std::string_view type() const { return description->type; }
  bool has(std::string_view key) const { return numbers.contains(key); }
  double number(std::string_view key, double otherwise) const {
    const auto found = numbers.find(key);
    return found == numbers.end() ? otherwise : found->second;
  }
  /// The position of a key's word among its words; 0, the default, where it is not given.
  int word(std::string_view key) const { return static_cast<int>(number(key, 0)); }
  std::vector<std::string> output_names() const;
  /// The names of outputs, and those of the columns that measures are taken of.
  std::vector<std::string> column_names() const;
  std::vector<MeasureRequest> measure_requests() const;
};

/// Reads the analyses of a list. `parameters` are those of the scene; `outputs` its outputs, or absent. Tasks that are
/// wrong are reported and left out.
std::vector<AnalysisTask> read_analyses(const JsonValue& list, const JsonValue& outputs, SceneTemplate& scene,
                                        const ParameterTable& parameters, Diagnostics& diagnostics);
/// The same of a single object.
std::optional<AnalysisTask> read_analysis(const JsonValue& object, const JsonValue& outputs, SceneTemplate& scene,
                                          const ParameterTable& parameters, Diagnostics& diagnostics);
/// Checks a list of outputs that no analysis may use.
std::vector<PlacedName> read_outputs(const JsonValue& list, SceneTemplate& scene, std::span<const double> parameters,
                                     Diagnostics& diagnostics);

}  // namespace catena
