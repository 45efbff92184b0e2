// The events of an analysis.
#include <fmt/format.h>

#include <array>

#include "catena/scene/reading/analysis_reader.hpp"
#include "catena/scene/reading/own_column_reader.hpp"

namespace catena {

void AnalysisReader::read_events(const JsonValue& list, AnalysisTask& task) {
  if (!list.is(JsonKind::array)) {
    error(list, fmt::format("\"events\" must be a list; this is {}", describe(list.kind())));
    return;
  }
  for (const JsonValue& object : list.elements()) read_event(object, task);
}

EventRequest::Impulse AnalysisReader::read_impulse(const JsonValue& object) {
  constexpr std::array<std::string_view, 2> keys{"i", "value"};
  std::array<JsonValue, keys.size()> v;
  EventRequest::Impulse impulse;
  impulse.place = object;
  if (!read_members(object, keys, "an impulse", v, diagnostics_)) return impulse;
  const auto pair_of = [&](const JsonValue& value, UnitKind unit, const FieldName& field) {
    const std::array<NumberValue, 2> read = reading_.numbers.read_pair(value, dimension_of(unit), field);
    const Evaluation<double> evaluation(value.source(), scene_.expressions, values_, diagnostics_, tables());
    return std::array<double, 2>{evaluation(read[0]), evaluation(read[1])};
  };
  if (v[0] && v[0].is(JsonKind::array) && v[0].size() == 2) {
    std::vector<JsonValue> parts;
    for (const JsonValue& part : v[0].elements()) parts.push_back(part);
    impulse.body = read_string(parts[0], {"i", "an impulse"}, diagnostics_);
    impulse.local = pair_of(parts[1], UnitKind::length, {"i", "an impulse"});
  } else if (v[0]) {
    const std::string_view text = read_string(v[0], {"i", "an impulse"}, diagnostics_);
    const std::size_t dot = text.find('.');
    impulse.body = text.substr(0, dot);
    if (dot != text.npos) impulse.point = text.substr(dot + 1);
  }
  if (v[1]) impulse.value = pair_of(v[1], UnitKind::momentum, {"value", "an impulse"});
  if (!v[0] || !v[1]) error(object, "an impulse needs \"i\", the point that it acts on, and \"value\": [px, py]");
  return impulse;
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
  if (v[1]) event.column = column_name(v[1], scene_, diagnostics_);
  if (!v[1]) error(object, "an event needs \"when\", the column that is watched");
  event.place = v[1];
  if (v[2]) event.value = number(words[2], v[2], {keys[2], "an event"});
  if (v[3]) event.direction = read_word(v[3], words[3].words, {keys[3], "an event"}, diagnostics_);
  if (v[4]) event.action = read_word(v[4], words[4].words, {keys[4], "an event"}, diagnostics_);
  event.element = text(5);
  event.element_place = v[5];
  if (event.action >= 2 && !v[5]) error(object, "an event that releases or engages needs \"element\"");
  if (event.action < 2 && v[5])
    error(v[5], fmt::format("\"element\" of an event that is to {} has no meaning",
                            words[4].words[static_cast<std::size_t>(event.action)]));
  if (v[6]) event.impulse = read_impulse(v[6]);
  if (v[6] && v[4]) error(v[4], "an event with an \"impulse\" has no other action");
  if (event.name.empty()) event.name = "event#" + std::to_string(task.events.size() + 1);
  if (v[1]) task.events.push_back(std::move(event));
}

}  // namespace catena
