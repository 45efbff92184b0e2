#include "catena/scene/reading/scene_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "catena/scene/json/near_miss.hpp"

namespace catena {

void report(const JsonValue& value, std::string message, Diagnostics& diagnostics) {
  diagnostics.error(value.source(), value.offset(), std::move(message));
}

std::string_view meant_key(const JsonValue& object, const JsonMember& member, std::span<const std::string_view> keys) {
  if (std::find(keys.begin(), keys.end(), member.name()) != keys.end()) return member.name();
  const std::string_view nearest = NearMiss(member.name()).consider_all(keys).best();
  return nearest.empty() || object.find(nearest) ? std::string_view() : nearest;
}

bool read_members(const JsonValue& object, std::span<const std::string_view> keys, std::string_view owner,
                  std::span<JsonValue> out, Diagnostics& diagnostics, Misspelt misspelt) {
  if (!object.is(JsonKind::object)) {
    report(object, fmt::format("{} must be an object {{...}}; this is {}", owner, describe(object.kind())),
           diagnostics);
    return false;
  }
  for (const JsonMember member : object.members()) {
    const std::string_view key = member.name();
    const bool guess = misspelt == Misspelt::as_meant;
    const auto meant = std::find(keys.begin(), keys.end(), guess ? meant_key(object, member, keys) : key);
    if (meant != keys.end()) {
      JsonValue& place = out[static_cast<std::size_t>(meant - keys.begin())];
      if (!place) place = member.value;  // a key given twice was reported when the text was parsed
      if (*meant == key) continue;
    }
    std::string hint = NearMiss(key).consider_all(keys).hint();
    if (hint.empty() && keys.size() <= 12) {
      for (const std::string_view k : keys) hint += fmt::format("{} {}", hint.empty() ? "; it has" : ",", k);
    }
    diagnostics.error(member.key.source(), member.key.offset(),
                      fmt::format("unknown key {} in {}{}", in_quotes(key), owner, hint), guess);
  }
  return true;
}

std::optional<JsonMember> read_only_member(const JsonValue& value, std::span<const std::string_view> keys,
                                           const FieldName& field, std::string_view what, Diagnostics& diagnostics) {
  std::string list;
  for (const std::string_view key : keys) list += (list.empty() ? "" : ", ") + std::string(key);
  for (const JsonMember member : value.members()) {
    if (std::find(keys.begin(), keys.end(), member.name()) == keys.end()) {
      std::string hint = NearMiss(member.name()).consider_all(keys).hint();
      if (hint.empty()) hint = "; it may be " + list;
      report(member.key, fmt::format("{}: unknown {} {}{}", field.text(), what, in_quotes(member.name()), hint),
             diagnostics);
      return {};
    }
  }
  if (value.size() == 1) return *value.members().begin();
  report(value, fmt::format("{} must have one of {}; this object has {} members", field.text(), list, value.size()),
         diagnostics);
  return {};
}

bool read_flag(const JsonValue& value, const FieldName& field, Diagnostics& diagnostics) {
  if (value.is(JsonKind::boolean)) return value.boolean();
  report(value, fmt::format("{} must be true or false; this is {}", field.text(), describe(value.kind())), diagnostics);
  return false;
}

int read_word(const JsonValue& value, std::span<const std::string_view> words, const FieldName& field,
              Diagnostics& diagnostics) {
  if (value.is(JsonKind::string)) {
    const auto found = std::find(words.begin(), words.end(), value.text());
    if (found != words.end()) return static_cast<int>(found - words.begin());
  }
  std::string list;
  for (std::size_t k = 0; k < words.size(); ++k) {
    list += (k == 0 ? "" : k + 1 == words.size() ? " or " : ", ") + in_quotes(words[k]);
  }
  const std::string given = value.is(JsonKind::string) ? in_quotes(value.text()) + " is none" +
                                                             NearMiss(value.text()).consider_all(words).hint()
                                                       : "this is " + std::string(describe(value.kind()));
  report(value, fmt::format("{} must be {}; {}", field.text(), list, given), diagnostics);
  return -1;
}

std::string_view read_string(const JsonValue& value, const FieldName& field, Diagnostics& diagnostics) {
  if (value.is(JsonKind::string)) return value.text();
  report(value, fmt::format("{} must be a text; this is {}", field.text(), describe(value.kind())), diagnostics);
  return {};
}

Beyond SceneReading::beyond(const JsonValue& value, SplineEnd end, std::string_view owner) {
  static constexpr std::array<std::string_view, 3> words{"error", "hold", "line"};
  const FieldName field{"beyond", owner};
  const int word = value ? read_word(value, words, field, diagnostics) : 0;
  if (value && end == SplineEnd::periodic && word >= 0)
    error(value, fmt::format("{}: a periodic curve or table has no ends; leave \"beyond\" out", field.text()));
  return word > 0 ? static_cast<Beyond>(word) : Beyond::error;
}

NameText SceneReading::name(const JsonValue& string, std::size_t from, std::size_t to) {
  const std::string_view whole = string.text();
  NameText name;
  name.text = whole.substr(from, to == std::string_view::npos ? to : to - from);
  name.offset = static_cast<std::uint32_t>(string.offset());
  name.position = static_cast<std::uint32_t>(from);
  if (!NameTemplate::has_braces(name.text)) return name;
  Parsed<NameTemplate> pattern = NameTemplate::parse(name.text, numbers.scope());
  if (!pattern) {
    diagnostics.error(string.source(), string.source().offset_in_string(string.offset(), from + pattern.error.position),
                      fmt::format("in the name {}: {}", in_quotes(whole), pattern.error.message));
    name.text = {};
    return name;
  }
  name.pattern = static_cast<int>(scene.patterns.size());
  scene.patterns.push_back(std::move(*pattern));
  return name;
}

std::string SceneReading::sample(const NameText& name) const {
  return name.pattern < 0 ? std::string(name.text) : scene.patterns[static_cast<std::size_t>(name.pattern)].sample();
}

std::uint32_t SceneReading::keep(std::span<const NumberValue> values) {
  const auto first = static_cast<std::uint32_t>(scene.numbers.size());
  scene.numbers.insert(scene.numbers.end(), values.begin(), values.end());
  return first;
}

}  // namespace catena
