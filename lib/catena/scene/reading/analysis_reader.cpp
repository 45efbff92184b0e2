#include "catena/scene/reading/analysis_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catena/analysis/dynamics/dynamics_options.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/evaluation.hpp"
#include "catena/scene/reading/own_column_reader.hpp"
#include "catena/scene/reading/task_numbers.hpp"

namespace catena {

const AnalysisDescription* AnalysisReader::read_type(const JsonValue& object) {
  const JsonValue type = object.find("type");
  if (!type) {
    error(object, "an analysis needs a \"type\"");
    return nullptr;
  }
  const std::string_view text = read_string(type, {"type", "an analysis"}, diagnostics_);
  if (!type.is(JsonKind::string)) return nullptr;
  const AnalysisDescription* found = find_analysis_type(text);
  if (!found) {
    NearMiss near(text);
    for (const AnalysisDescription& d : analysis_descriptions()) near.consider(d.type);
    error(type, fmt::format("unknown analysis {}{}", in_quotes(text), near.hint()));
  }
  return found;
}

std::vector<PlacedName> AnalysisReader::names(const JsonValue& list, const FieldName& field,
                                              std::span<const double> parameters) {
  std::vector<PlacedName> result;
  const auto take = [&](const JsonValue& value) {
    const std::string_view text = read_string(value, field, diagnostics_);
    if (!value.is(JsonKind::string)) return;
    PlacedName placed{std::string(text), value};
    if (text.starts_with('=')) {
      placed.name = column_name(value, scene_, diagnostics_);
      if (placed.name.empty()) return;
    } else if (NameTemplate::has_braces(text)) {
      const NameText pattern = reading_.name(value);
      placed.name.clear();
      if (pattern.pattern < 0) return;
      const Evaluation<double> evaluation(value.source(), scene_.expressions, parameters, diagnostics_);
      if (!evaluation.append_name(scene_.patterns[static_cast<std::size_t>(pattern.pattern)], value.offset(),
                                  placed.name))
        return;
    }
    result.push_back(std::move(placed));
  };
  if (!list.is(JsonKind::array)) {
    error(list, fmt::format("{} must be a list of names; this is {}", field.text(), describe(list.kind())));
    return result;
  }
  result.reserve(list.size());
  for (const JsonValue& value : list.elements()) take(value);
  return result;
}

// The value of a number, and where it is kept if parameters change it.
double AnalysisReader::evaluated(const NumberValue& read, const JsonValue& value, TaskNumber place) {
  const double result = evaluation(value)(read);
  if (read.valid() && !read.is_constant()) {
    place.value = read;
    place.loop_values = loop_values_;
    place.as_read = result;
    varying_.push_back(std::move(place));
  }
  return result;
}

double AnalysisReader::number(const AnalysisKey& key, const JsonValue& value, const FieldName& field,
                              TaskNumber place) {
  const ExpectedDimension unit = key.unit == UnitKind::own ? dimension_of_parameter_ : dimension_of(key.unit);
  place.key = &key;
  const double result = evaluated(reading_.numbers.read(value, unit, field), value, std::move(place));
  if (std::isnan(result)) return result;
  if (const std::optional<std::string> why = out_of_key(key, result)) error(value, field.text() + " " + *why);
  return result;
}

void AnalysisReader::read_parameters(const JsonValue& set, AnalysisTask& task) {
  auto table = std::make_shared<ParameterTable>(parameters_);
  if (set) {
    table->set(set, scene_.expressions, diagnostics_);
    task.changes_parameters = true;
    if (set.is(JsonKind::object)) {
      for (const JsonMember member : set.members()) {
        const int parameter = parameters_.names().find(member.name());
        if (parameter >= 0) task.set_parameters.push_back(parameter);
      }
    }
  }
  task.parameters = table->evaluate<double>(scene_.expressions, diagnostics_);
  task.table = std::move(table);
}

void AnalysisReader::read_times(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task) {
  const FieldName field{key.name, task.type()};
  task.at.emplace();
  if (!value.is(JsonKind::array)) {
    task.at->push_back(number(key, value, field, {.place = TaskNumber::Place::instant}));
    return;
  }
  for (const JsonValue& instant : value.elements()) {
    const TaskNumber place{.place = TaskNumber::Place::instant, .item = task.at->size()};
    task.at->push_back(number(key, instant, field, place));
  }
  if (value.size() == 0) error(value, field.text() + " may not be an empty list");
}

// The number of a parameter that is named; -1 where there is none of that name.
int AnalysisReader::read_parameter(const JsonValue& value, const FieldName& field) {
  const std::string_view name = read_string(value, field, diagnostics_);
  const int index = parameters_.names().find(name);
  if (value.is(JsonKind::string) && index < 0) {
    error(value, fmt::format("{}: unknown parameter {}{}", field.text(), in_quotes(name),
                             NearMiss(name).consider_all(parameters_.names().all()).hint()));
  }
  return index;
}

void AnalysisReader::read_parameter_key(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task) {
  const int index = read_parameter(value, {key.name, task.type()});
  task.numbers[key.name] = index;
  if (index >= 0) dimension_of_parameter_ = parameters_.names().dimension(index);
}

void AnalysisReader::read_key(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task) {
  const FieldName field{key.name, task.type()};
  switch (key.kind) {
    case KeyKind::number:
    case KeyKind::whole:
      task.numbers[key.name] = number(key, value, field, {});
      break;
    case KeyKind::time:
      task.at = std::vector<double>{number(key, value, field, {.place = TaskNumber::Place::instant})};
      break;
    case KeyKind::times:
      read_times(key, value, task);
      break;
    case KeyKind::flag:
      task.numbers[key.name] = read_flag(value, field, diagnostics_) ? 1 : 0;
      break;
    case KeyKind::word:
      if (!key.words.empty()) task.numbers[key.name] = read_word(value, key.words, field, diagnostics_);
      break;
    case KeyKind::columns:
      task.outputs = names(value, field, task.parameters);
      break;
    case KeyKind::parameter:
      read_parameter_key(key, value, task);
      break;
    case KeyKind::set:
    case KeyKind::impulse:  // of events
      break;
    case KeyKind::events:
      read_events(value, task);
      break;
    case KeyKind::event_blocks:
      read_event_blocks(value, task);
      break;
    case KeyKind::measures:
      read_measures(value, task);
      break;
    case KeyKind::analysis:
      read_inner_analyses(value, task);
      break;
    case KeyKind::names:
      read_parameter_names(value, task);
      break;
    case KeyKind::variables:
      read_variables(value, task);
      break;
    case KeyKind::over:
      read_over(value, task);
      break;
    case KeyKind::objective:
      task.goal.maximise = key.name == "maximise";
      read_objective(value, task);
      break;
    case KeyKind::relations:
      read_relations(value, task);
      break;
  }
}

// until, every and at exclude each other in part, and must not result in an absurd number of rows.
void AnalysisReader::check_times(const std::vector<JsonValue>& values, const AnalysisTask& task) {
  const auto given = [&](std::string_view key) {
    for (std::size_t k = 0; k < task.description->keys.size(); ++k) {
      if (task.description->keys[k].name == key) return values[k];
    }
    return JsonValue();
  };
  const JsonValue until = given("until"), every = given("every"), at = given("at");
  if (at && (until || every)) {
    error(at, fmt::format("{} may not have \"at\" together with \"until\" or \"every\"", task.type()));
  } else if (every && !until) {
    error(every, fmt::format("\"every\" of {} needs \"until\" too", task.type()));
  } else if (const std::optional<std::string> why = too_many_rows(task); why && every) {
    error(every, *why);
  }
}

void AnalysisReader::check_method(const JsonValue& object, const AnalysisTask& task) {
  const bool is_rattle = task.word("method") == static_cast<int>(IntegrationMethod::rattle);
  if (is_rattle && !(task.number("step", 0) > 0))
    error(object.find("method"),
          "method \"rattle\" makes steps of one length, which its accuracy follows from: give \"step\", s");
  if (const double tolerance = task.number("tolerance", DynamicsOptions{}.tolerance); tolerance >= 1) {
    error(object.find("tolerance"),
          fmt::format("\"tolerance\" of dynamics is a relative error and must be below 1; it is {}", tolerance));
  } else if (tolerance > 0 && tolerance < DynamicsOptions::least_tolerance) {
    error(object.find("tolerance"),
          fmt::format("\"tolerance\" of dynamics must be {} or more, which double precision holds; it is {}",
                      DynamicsOptions::least_tolerance, tolerance));
  }
  if (const double rho = task.number("rho", 0); rho > 1)
    error(object.find("rho"),
          fmt::format("\"rho\" of dynamics is what a step leaves of a fast vibration, 0 ... 1; it is {}", rho));
}

std::optional<AnalysisTask> AnalysisReader::read(const JsonValue& object, const JsonValue& scene_outputs) {
  if (!object.is(JsonKind::object)) {
    error(object, fmt::format("an analysis must be an object {{...}}; this is {}", describe(object.kind())));
    return {};
  }
  scene_outputs_ = scene_outputs;
  AnalysisTask task;
  task.description = read_type(object);
  if (!task.description) return {};
  task.place = object;
  const std::vector<AnalysisKey>& known = task.description->keys;
  std::vector<std::string_view> keys;
  for (const AnalysisKey& key : known) keys.push_back(key.name);
  std::vector<JsonValue> values(keys.size());
  read_members(object, keys, task.type(), values, diagnostics_);

  JsonValue set;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (known[k].kind == KeyKind::set) set = values[k];
  }
  read_parameters(set, task);
  values_ = task.parameters;
  dimension_of_parameter_.reset();
  bool own_outputs = false;
  const bool has_rows_of_inner = task.type() == "sensitivity";
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!values[k]) {
      if (known[k].required) error(object, fmt::format("{} needs {}", task.type(), in_quotes(keys[k])));
      continue;
    }
    if (keys[k] == "type") continue;
    if (keys[k] == "outputs" && has_rows_of_inner) {
      scene_outputs_ = values[k];
      continue;
    }
    own_outputs = own_outputs || keys[k] == "outputs";
    read_key(known[k], values[k], task);
  }
  task.varying = std::move(varying_);
  task.from_initial = task.word("from") == 1;
  check_times(values, task);
  if (task.type() == "dynamics") check_method(object, task);
  if (task.type() == "optimise") check_design(object, task);
  if (task.type() == "sweep") check_sweep(object, task);
  if (!own_outputs && !has_rows_of_inner && scene_outputs && task.description->find("outputs")) {
    task.outputs = names(scene_outputs, {"outputs"}, task.parameters);
  }
  return task;
}

std::vector<std::string> AnalysisTask::output_names() const {
  std::vector<std::string> names;
  names.reserve(outputs.size());
  for (const PlacedName& placed : outputs) names.push_back(placed.name);
  return names;
}

std::vector<std::string> AnalysisTask::column_names() const {
  std::vector<std::string> names = output_names();
  if (measures.empty()) return names;
  for (const PlacedMeasure& measure : measures) {
    for (const PlacedName& placed : measure.columns) names.push_back(placed.name);
  }
  return names;
}

std::vector<MeasureRequest> AnalysisTask::measure_requests() const {
  std::vector<MeasureRequest> requests;
  for (const PlacedMeasure& measure : measures) requests.push_back(measure.request);
  return requests;
}

std::optional<AnalysisTask> read_analysis(const JsonValue& object, const JsonValue& outputs, SceneTemplate& scene,
                                          const ParameterTable& parameters, Diagnostics& diagnostics) {
  return AnalysisReader(scene, parameters, diagnostics).read(object, outputs);
}

std::vector<AnalysisTask> read_analyses(const JsonValue& list, const JsonValue& outputs, SceneTemplate& scene,
                                        const ParameterTable& parameters, Diagnostics& diagnostics) {
  std::vector<AnalysisTask> tasks;
  if (!list.is(JsonKind::array)) {
    report(list, fmt::format("\"analyses\" must be a list; this is {}", describe(list.kind())), diagnostics);
    return tasks;
  }
  for (const JsonValue& object : list.elements()) {
    if (auto task = read_analysis(object, outputs, scene, parameters, diagnostics)) tasks.push_back(std::move(*task));
  }
  return tasks;
}

std::vector<PlacedName> read_outputs(const JsonValue& list, SceneTemplate& scene, std::span<const double> parameters,
                                     Diagnostics& diagnostics) {
  return AnalysisReader(scene, scene.parameters, diagnostics).names(list, {"outputs"}, parameters);
}

}  // namespace catena
