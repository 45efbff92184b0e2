#include <fmt/format.h>

#include <cmath>

#include "catena/scene/analysis_task.hpp"
#include "catena/scene/evaluation.hpp"
#include "catena/scene/near_miss.hpp"
#include "catena/scene/number_domain.hpp"
#include "catena/scene/scene_reading.hpp"

namespace catena {
namespace {

constexpr double most_rows = 1e9;

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
    if (NameTemplate::has_braces(text)) {
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

double AnalysisReader::number(const AnalysisKey& key, const JsonValue& value, const FieldName& field) {
  const ExpectedDimension unit = key.unit == UnitKind::none && key.domain == Domain::any
                                     ? ExpectedDimension()
                                     : ExpectedDimension(dimension_of(key.unit));
  const NumberValue read = reading_.numbers.read(value, unit, field);
  const Evaluation<double> evaluation(value.source(), scene_.expressions, values_, diagnostics_);
  const double result = evaluation(read);
  if (std::isnan(result)) return result;
  const bool whole = key.kind == KeyKind::whole;
  if (whole && (result < 1 || result != std::round(result) || result > 2e9)) {
    error(value, fmt::format("{} must be a whole number above zero; it is {}", field.text(), result));
  } else if (!whole && !fits(result, key.domain)) {
    error(value, field.text() + " " + out_of_domain(result, key.domain));
  }
  return result;
}

void AnalysisReader::read_parameters(const JsonValue& set, AnalysisTask& task) {
  if (!set) {
    task.parameters = parameters_.evaluate<double>(scene_.expressions, diagnostics_);
    return;
  }
  ParameterTable changed = parameters_;
  changed.set(set, scene_.expressions, diagnostics_);
  task.parameters = changed.evaluate<double>(scene_.expressions, diagnostics_);
  task.changes_parameters = true;
}

void AnalysisReader::read_key(const AnalysisKey& key, const JsonValue& value, AnalysisTask& task) {
  const FieldName field{key.name, task.type()};
  switch (key.kind) {
    case KeyKind::number:
    case KeyKind::whole:
      task.numbers[key.name] = number(key, value, field);
      break;
    case KeyKind::time:
      task.at = std::vector<double>{number(key, value, field)};
      break;
    case KeyKind::times:
      task.at.emplace();
      if (!value.is(JsonKind::array)) {
        task.at->push_back(number(key, value, field));
        break;
      }
      for (const JsonValue& instant : value.elements()) task.at->push_back(number(key, instant, field));
      if (value.size() == 0) error(value, field.text() + " may not be an empty list");
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
    case KeyKind::parameter: {
      const std::string_view name = read_string(value, field, diagnostics_);
      const int index = parameters_.names().find(name);
      if (value.is(JsonKind::string) && index < 0) {
        error(value, fmt::format("{}: unknown parameter {}{}", field.text(), in_quotes(name),
                                 NearMiss(name).consider_all(parameters_.names().all()).hint()));
      }
      task.numbers[key.name] = index;
      break;
    }
    case KeyKind::set:
      break;
    case KeyKind::events:
      read_events(value, task);
      break;
  }
}

void AnalysisReader::read_events(const JsonValue& list, AnalysisTask& task) {
  if (!list.is(JsonKind::array)) {
    error(list, fmt::format("\"events\" must be a list; this is {}", describe(list.kind())));
    return;
  }
  for (const JsonValue& object : list.elements()) read_event(object, task);
}

void AnalysisReader::read_event(const JsonValue& object, AnalysisTask& task) {
  std::vector<std::string_view> keys;
  for (const AnalysisKey& key : event_keys()) keys.push_back(key.name);
  std::vector<JsonValue> v(keys.size());
  if (!read_members(object, keys, "an event", v, diagnostics_)) return;
  const auto& words = event_keys();
  EventRequest event;
  const auto text = [&](std::size_t k) {
    return v[k] ? std::string(read_string(v[k], {keys[k], "an event"}, diagnostics_)) : std::string();
  };
  event.name = text(0);
  event.column = text(1);
  if (!v[1]) error(object, "an event needs \"when\", the column that is watched");
  event.place = v[1];
  if (v[2]) event.value = number(words[2], v[2], {keys[2], "an event"});
  if (v[3]) event.direction = read_word(v[3], words[3].words, {keys[3], "an event"}, diagnostics_);
  if (v[4]) event.action = read_word(v[4], words[4].words, {keys[4], "an event"}, diagnostics_);
  event.element = text(5);
  if (event.action >= 2 && !v[5]) error(object, "an event that releases or engages needs \"element\"");
  if (event.name.empty()) event.name = "event#" + std::to_string(task.events.size() + 1);
  if (v[1]) task.events.push_back(std::move(event));
}

// until, every and at exclude each other in part, and should not ask for more rows than anyone can want.
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
  } else if (until && every && task.number("until", 0) / task.number("every", 1) > most_rows) {
    error(every, fmt::format("{} would give more than {} rows", task.type(), most_rows));
  }
}

std::optional<AnalysisTask> AnalysisReader::read(const JsonValue& object, const JsonValue& scene_outputs) {
  if (!object.is(JsonKind::object)) {
    error(object, fmt::format("an analysis must be an object {{...}}; this is {}", describe(object.kind())));
    return {};
  }
  AnalysisTask task;
  task.description = read_type(object);
  if (!task.description) return {};
  task.place = object;
  const std::vector<AnalysisKey>& known = task.description->keys;
  std::vector<std::string_view> keys;
  for (const AnalysisKey& key : known) keys.push_back(key.name);
  std::vector<JsonValue> values(keys.size());
  if (task.description->any_key) {
    for (std::size_t k = 0; k < keys.size(); ++k) values[k] = object.find(keys[k]);
  } else {
    read_members(object, keys, task.type(), values, diagnostics_);
  }

  JsonValue set;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (known[k].kind == KeyKind::set) set = values[k];
  }
  read_parameters(set, task);
  values_ = task.parameters;
  bool own_outputs = false;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!values[k]) {
      if (known[k].required) error(object, fmt::format("{} needs {}", task.type(), in_quotes(keys[k])));
      continue;
    }
    if (keys[k] == "type") continue;
    own_outputs = own_outputs || keys[k] == "outputs";
    read_key(known[k], values[k], task);
  }
  task.from_initial = task.word("from") == 1;
  check_times(values, task);
  if (!own_outputs && scene_outputs && task.description->find("outputs")) {
    task.outputs = names(scene_outputs, {"outputs"}, task.parameters);
  }
  return task;
}

}  // namespace

std::vector<std::string> AnalysisTask::output_names() const {
  std::vector<std::string> names;
  names.reserve(outputs.size());
  for (const PlacedName& placed : outputs) names.push_back(placed.name);
  return names;
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
