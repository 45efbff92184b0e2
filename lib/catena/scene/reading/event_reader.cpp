// The events of an analysis.
#include <fmt/format.h>

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
  if (event.name.empty()) event.name = "event#" + std::to_string(task.events.size() + 1);
  if (v[1]) task.events.push_back(std::move(event));
}

}  // namespace catena
