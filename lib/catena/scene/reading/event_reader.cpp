// The events of an analysis.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "catena/scene/numbers/name_rules.hpp"
#include "catena/scene/reading/analysis_reader.hpp"
#include "catena/scene/reading/own_column_reader.hpp"
#include "catena/scene/reading/scene_reader.hpp"

namespace catena {
namespace {

constexpr std::string_view block_owner = "a block of events";
// As deep as blocks of the scene; and as many events as can be watched in a reasonable time.
constexpr std::size_t deepest_event_block = 8;
constexpr std::int64_t most_events = 1'000'000;
constexpr double largest_whole = 1e9;

}  // namespace

void AnalysisReader::read_events(const JsonValue& list, AnalysisTask& task) {
  if (!list.is(JsonKind::array)) {
    error(list, fmt::format("\"events\" must be a list; this is {}", describe(list.kind())));
    return;
  }
  for (const JsonValue& object : list.elements()) read_event(object, task);
}

Evaluation<double> AnalysisReader::evaluation(const JsonValue& value) const {
  Evaluation<double> evaluation(value.source(), scene_.expressions, values_, diagnostics_, tables());
  for (std::size_t k = 0; k < loop_names_.size(); ++k) {
    evaluation.enter_block(loop_names_[k]);
    evaluation.set_variable(loop_values_[k]);
  }
  return evaluation;
}

void AnalysisReader::read_event_blocks(const JsonValue& list, AnalysisTask& task) {
  if (!list.is(JsonKind::array)) {
    error(list, fmt::format("\"replicate\" must be a list of blocks; this is {}", describe(list.kind())));
    return;
  }
  for (const JsonValue& object : list.elements()) read_event_block(object, task);
}

std::optional<std::int64_t> AnalysisReader::whole_number(const AnalysisKey& key, const JsonValue& value) {
  const FieldName field{key.name, block_owner};
  const double number = this->number(key, value, field, {.place = TaskNumber::Place::fixed});
  if (std::isnan(number)) return {};  // that was reported
  if (number == std::round(number) && std::abs(number) <= largest_whole) return static_cast<std::int64_t>(number);
  error(value, fmt::format("{} must be a whole number; it is {}", field.text(), number));
  return {};
}

void AnalysisReader::read_event_block(const JsonValue& object, AnalysisTask& task) {
  const auto& words = event_block_keys();
  std::vector<std::string_view> keys;
  for (const AnalysisKey& key : words) keys.push_back(key.name);
  std::vector<JsonValue> v(keys.size());
  if (loop_names_.size() >= deepest_event_block) return error(object, "replicate blocks are nested too deeply");
  if (!read_members(object, keys, block_owner, v, diagnostics_)) return;
  if (!v[0]) return error(object, "a block of events needs \"count\"");
  if (!v[3] && !v[4]) return error(object, "a block of events repeats \"events\"; this one has none");
  const std::optional<std::int64_t> count = whole_number(words[0], v[0]);
  const std::optional<std::int64_t> first = v[1] ? whole_number(words[1], v[1]) : std::int64_t{1};
  if (!count || !first) return;
  if (*count < 0) return error(v[0], fmt::format("\"count\" of a block of events is {}", *count));
  std::string variable(block_variable);
  if (v[2]) {
    variable = read_string(v[2], {keys[2], block_owner}, diagnostics_);
    if (const std::string problem = parameter_name_problem(variable); !problem.empty()) return error(v[2], problem);
  }
  if (*count > most_events) return error(v[0], fmt::format("more than {} events", most_events));
  loop_names_.push_back(variable);
  loop_values_.push_back(0);
  reading_.numbers.enter_block(variable);
  repeat_events(*first, *count, v[3], v[4], task);
  if (std::ssize(task.events) > most_events) error(v[0], fmt::format("more than {} events", most_events));
  reading_.numbers.leave_block();
  loop_names_.pop_back();
  loop_values_.pop_back();
}

// A mistake in a block is reported for the first k at which it shows.
void AnalysisReader::repeat_events(std::int64_t first, std::int64_t count, const JsonValue& events,
                                   const JsonValue& blocks, AnalysisTask& task) {
  const std::size_t errors = diagnostics_.count();
  for (std::int64_t k = 0; k < count && diagnostics_.count() == errors && std::ssize(task.events) <= most_events; ++k) {
    loop_values_.back() = static_cast<double>(first + k);
    if (events) read_events(events, task);
    if (blocks) read_event_blocks(blocks, task);
  }
}

// A text in which {expressions} stand for whole numbers.
std::string AnalysisReader::event_text(const JsonValue& value, const FieldName& field) {
  const std::string_view text = read_string(value, field, diagnostics_);
  if (!NameTemplate::has_braces(text)) return std::string(text);
  const Parsed<NameTemplate> pattern = NameTemplate::parse(text, reading_.numbers.scope());
  if (!pattern) {
    diagnostics_.error(value.source(), value.source().offset_in_string(value.offset(), pattern.error.position),
                       fmt::format("in {}: {}", field.text(), pattern.error.message));
    return {};
  }
  std::string written;
  return evaluation(value).append_name(*pattern, value.offset(), written) ? written : std::string();
}

EventRequest::Impulse AnalysisReader::read_impulse(const JsonValue& object, std::size_t event) {
  constexpr std::array<std::string_view, 2> keys{"i", "value"};
  std::array<JsonValue, keys.size()> v;
  EventRequest::Impulse impulse;
  impulse.place = object;
  if (!read_members(object, keys, "an impulse", v, diagnostics_)) return impulse;
  const auto pair_of = [&](const JsonValue& value, UnitKind unit, const FieldName& field, TaskNumber::Place place) {
    const std::array<NumberValue, 2> read = reading_.numbers.read_pair(value, dimension_of(unit), field);
    return std::array<double, 2>{evaluated(read[0], value, {.place = place, .item = event, .part = 0}),
                                 evaluated(read[1], value, {.place = place, .item = event, .part = 1})};
  };
  if (v[0] && v[0].is(JsonKind::array) && v[0].size() == 2) {
    std::vector<JsonValue> parts;
    for (const JsonValue& part : v[0].elements()) parts.push_back(part);
    impulse.body = event_text(parts[0], {"i", "an impulse"});
    impulse.local = pair_of(parts[1], UnitKind::length, {"i", "an impulse"}, TaskNumber::Place::struck_point);
  } else if (v[0]) {
    const std::string text = event_text(v[0], {"i", "an impulse"});
    const std::size_t dot = text.find('.');
    impulse.body = text.substr(0, dot);
    if (dot != text.npos) impulse.point = text.substr(dot + 1);
  }
  if (v[1]) impulse.value = pair_of(v[1], UnitKind::momentum, {"value", "an impulse"}, TaskNumber::Place::impulse);
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
  const auto text = [&](std::size_t k) { return v[k] ? event_text(v[k], {keys[k], "an event"}) : std::string(); };
  event.name = text(0);
  if (v[1]) event.column = column_name(v[1], text(1), {loop_names_, loop_values_}, scene_, diagnostics_);
  if (!v[1]) error(object, "an event needs \"when\", the column that is watched");
  event.place = v[1];
  if (v[2]) {
    event.value =
        number(words[2], v[2], {keys[2], "an event"}, {.place = TaskNumber::Place::event, .item = task.events.size()});
    event.value_dimension = reading_.numbers.dimension();
    event.value_place = v[2];
  }
  if (v[3]) event.direction = read_word(v[3], words[3].words, {keys[3], "an event"}, diagnostics_);
  if (v[4]) event.action = read_word(v[4], words[4].words, {keys[4], "an event"}, diagnostics_);
  const bool strikes = event.action >= 0 && words[4].words[static_cast<std::size_t>(event.action)] == "impulse";
  if (strikes) event.action = 0;  // it is the impulse that says so
  if (strikes && !v[6]) error(v[4], "an event with the action \"impulse\" needs \"impulse\": {\"i\", \"value\"}");
  event.element = text(5);
  event.element_place = v[5];
  if (event.action >= 2 && !v[5]) error(object, "an event that releases or engages needs \"element\"");
  if (event.action >= 0 && event.action < 2 && v[5])
    error(v[5], fmt::format("\"element\" of an event that is to {} has no meaning",
                            words[4].words[static_cast<std::size_t>(event.action)]));
  if (v[6]) event.impulse = read_impulse(v[6], task.events.size());
  if (v[6] && v[4] && !strikes) error(v[4], "an event with an \"impulse\" has no other action");
  if (event.name.empty()) event.name = "event#" + std::to_string(task.events.size() + 1);
  if (v[1] && !event.column.empty()) task.events.push_back(std::move(event));
}

}  // namespace catena
