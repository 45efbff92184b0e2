// Functions of time: from JSON to templates.
#include <fmt/format.h>

#include <array>

#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

using Kind = FunctionTemplate::Kind;
constexpr std::array<std::string_view, 7> function_keys{"polynomial", "harmonic", "step",   "law",
                                                        "spline",     "sum",      "product"};
constexpr std::array<std::string_view, 3> end_words{"natural", "clamped", "periodic"};

}  // namespace

int SceneReading::function(const JsonValue& value, const ExpectedDimension& unit, const FieldName& field,
                           NumberValue& plain) {
  if (!value.is(JsonKind::object)) {
    if (value.is(JsonKind::array)) {
      error(value, fmt::format("{} must be a number or a function of time such as {{\"polynomial\": [0, 1]}}; this is "
                               "a list",
                               field.text()));
    } else {
      plain = numbers.read(value, unit, field);
    }
    return -1;
  }
  scene.functions.push_back(function_object(value, unit, field));
  return static_cast<int>(scene.functions.size()) - 1;
}

FunctionTemplate SceneReading::function_part(const JsonValue& value, const ExpectedDimension& unit,
                                             const FieldName& field) {
  if (value.is(JsonKind::object)) return function_object(value, unit, field);
  FunctionTemplate constant;
  constant.offset = static_cast<std::uint32_t>(value.offset());
  constant.numbers.push_back(numbers.read(value, unit, field));
  return constant;
}

FunctionTemplate SceneReading::function_object(const JsonValue& value, const ExpectedDimension& unit,
                                               const FieldName& field) {
  FunctionTemplate result;
  result.offset = static_cast<std::uint32_t>(value.offset());
  result.numbers.resize(1);
  const std::optional<JsonMember> member =
      read_only_member(value, function_keys, field, "function of time", diagnostics);
  if (!member) return result;
  const auto key = std::find(function_keys.begin(), function_keys.end(), member->name());
  result.kind = static_cast<Kind>(key - function_keys.begin() + 1);
  result.numbers.clear();
  const JsonValue& data = member->value;
  const std::string owner = fmt::format("{} in {}", *key, field.text());
  const Dimension second = dimension_of(UnitKind::time), radian = dimension_of(UnitKind::angle);
  // A number by its key; absent ones are 0 unless required.
  const auto take = [&](const JsonValue& number, std::string_view name, const ExpectedDimension& dimension,
                        bool required) {
    if (number) {
      result.numbers.push_back(numbers.read(number, dimension, {name, owner}));
    } else {
      if (required) error(data, fmt::format("{} needs {}", owner, in_quotes(name)));
      result.numbers.push_back(required ? NumberValue() : NumberValue::constant(0));
    }
  };
  switch (result.kind) {
    case Kind::constant:
    case Kind::state:  // no function of time: read before
      break;
    case Kind::polynomial: {
      if (!data.is(JsonKind::array) || data.size() == 0) {
        error(data, fmt::format("{} must be a list of coefficients [c0, c1, ...]", owner));
        break;
      }
      ExpectedDimension dimension = unit;
      for (const JsonValue& coefficient : data.elements()) {
        result.numbers.push_back(numbers.read(coefficient, dimension, {"polynomial", field.text()}));
        if (dimension) dimension = *dimension / second;
      }
      break;
    }
    case Kind::harmonic: {
      static constexpr std::array<std::string_view, 4> keys{"amplitude", "omega", "phase", "offset"};
      std::array<JsonValue, keys.size()> v;
      if (!read_members(data, keys, owner, v, diagnostics)) break;
      take(v[0], keys[0], unit, true);
      take(v[1], keys[1], radian / second, true);
      take(v[2], keys[2], radian, false);
      take(v[3], keys[3], unit, false);
      break;
    }
    case Kind::step: {
      static constexpr std::array<std::string_view, 5> keys{"t0", "t1", "from", "to", "order"};
      std::array<JsonValue, keys.size()> v;
      if (!read_members(data, keys, owner, v, diagnostics)) break;
      for (std::size_t k = 0; k < 4; ++k) take(v[k], keys[k], k < 2 ? ExpectedDimension(second) : unit, true);
      if (v[4]) {
        const bool good = v[4].is(JsonKind::number) && (v[4].number() == 3 || v[4].number() == 5);
        if (!good) error(v[4], fmt::format("{} must be 3 or 5", FieldName{"order", owner}.text()));
        if (good) result.order = static_cast<int>(v[4].number());
      }
      break;
    }
    case Kind::law: {
      static constexpr std::array<std::string_view, 5> keys{"type", "t0", "t1", "from", "to"};
      std::array<JsonValue, keys.size()> v;
      if (!read_members(data, keys, owner, v, diagnostics)) break;
      if (!v[0]) error(data, fmt::format("{} needs \"type\"", owner));
      if (v[0]) {
        if (const int word = read_word(v[0], motion_laws, {"type", owner}, diagnostics); word >= 0)
          result.law = static_cast<MotionLaw>(word);
      }
      for (std::size_t k = 1; k < 5; ++k) take(v[k], keys[k], k < 3 ? ExpectedDimension(second) : unit, true);
      break;
    }
    case Kind::spline: {
      static constexpr std::array<std::string_view, 5> keys{"t", "value", "end", "beyond", "points"};
      std::array<JsonValue, keys.size()> v;
      if (!read_members(data, keys, owner, v, diagnostics)) break;
      if (v[2]) {
        if (const int word = read_word(v[2], end_words, {"end", owner}, diagnostics); word >= 0)
          result.end = static_cast<SplineEnd>(word);
      }
      std::array<std::vector<NumberValue>, 2> lists;
      if (v[4]) {
        if (v[0] || v[1]) error(v[4], fmt::format("{} has \"points\", or \"t\" and \"value\", not both", owner));
        const std::vector<NumberValue> pairs =
            pair_list(v[4], second, unit, {keys[4], owner}, {.repeats = result.end == SplineEnd::periodic});
        for (std::size_t k = 0; k < pairs.size(); ++k) lists[k % 2].push_back(pairs[k]);
      } else {
        for (std::size_t k = 0; k < 2; ++k) {
          if (!v[k]) error(data, fmt::format("{} needs {}", owner, in_quotes(keys[k])));
          if (v[k]) lists[k] = number_list(v[k], k == 0 ? ExpectedDimension(second) : unit, {keys[k], owner});
        }
      }
      for (const auto& list : lists) result.numbers.insert(result.numbers.end(), list.begin(), list.end());
      if (v[0] && v[1] && !lists[0].empty() && !lists[1].empty() && lists[0].size() != lists[1].size()) {
        error(v[1], fmt::format("{}: {} times, but {} values", owner, lists[0].size(), lists[1].size()));
        result.numbers.clear();
      }
      result.beyond = beyond(v[3], result.end, owner);
      break;
    }
    case Kind::sum:
    case Kind::product: {
      if (!data.is(JsonKind::array) || data.size() == 0) {
        error(data, fmt::format("{} must be a list of functions", owner));
        break;
      }
      for (const JsonValue& part : data.elements()) {
        result.parts.push_back(
            function_part(part, result.kind == Kind::sum ? unit : ExpectedDimension(), {*key, field.text()}));
      }
      break;
    }
  }
  return result;
}

}  // namespace catena
