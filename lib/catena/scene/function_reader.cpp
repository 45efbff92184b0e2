// Functions of time, curves and tables: from JSON to templates.
#include <fmt/format.h>

#include <array>

#include "catena/scene/near_miss.hpp"
#include "catena/scene/scene_reading.hpp"

namespace catena {
namespace {

using Kind = FunctionTemplate::Kind;
constexpr std::array<std::string_view, 6> function_keys{"polynomial", "harmonic", "step", "spline", "sum", "product"};
constexpr std::array<std::string_view, 4> curve_keys{"circle", "spline", "polar", "line"};
constexpr std::array<std::string_view, 3> end_words{"natural", "clamped", "periodic"};

/// The only member of an object whose key says what it is; nothing, with a report, if there is none or more.
std::optional<JsonMember> only_member(const JsonValue& value, std::span<const std::string_view> keys,
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

/// One number a line of a list of pairs.
void append_pairs(const JsonValue& list, const ExpectedDimension& first, const ExpectedDimension& second,
                  const FieldName& field, NumberReader& reader, std::vector<NumberValue>& out,
                  Diagnostics& diagnostics) {
  if (!list.is(JsonKind::array)) {
    report(list, fmt::format("{} must be a list of pairs; this is {}", field.text(), describe(list.kind())),
           diagnostics);
    return;
  }
  for (const JsonValue& pair : list.elements()) {
    if (!pair.is(JsonKind::array) || pair.size() != 2) {
      report(pair, fmt::format("{} must be a list of pairs [a, b]", field.text()), diagnostics);
      continue;
    }
    auto element = pair.elements().begin();
    out.push_back(reader.read(*element, first, field));
    ++element;
    out.push_back(reader.read(*element, second, field));
  }
}

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
  const std::optional<JsonMember> member = only_member(value, function_keys, field, "function of time", diagnostics);
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
    case Kind::spline: {
      static constexpr std::array<std::string_view, 3> keys{"t", "value", "end"};
      std::array<JsonValue, keys.size()> v;
      if (!read_members(data, keys, owner, v, diagnostics)) break;
      for (std::size_t k = 0; k < 2; ++k) {
        if (!v[k]) {
          error(data, fmt::format("{} needs {}", owner, in_quotes(keys[k])));
          continue;
        }
        const auto list = numbers.read_list(v[k], k == 0 ? ExpectedDimension(second) : unit, {keys[k], owner});
        result.numbers.insert(result.numbers.end(), list.begin(), list.end());
      }
      if (v[0] && v[1] && v[0].is(JsonKind::array) && v[1].is(JsonKind::array) && v[0].size() != v[1].size()) {
        error(v[1], fmt::format("{}: {} times, but {} values", owner, v[0].size(), v[1].size()));
        result.numbers.clear();
      }
      if (v[2]) {
        if (const int word = read_word(v[2], end_words, {"end", owner}, diagnostics); word >= 0)
          result.end = static_cast<SplineEnd>(word);
      }
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

int SceneReading::curve(const JsonValue& value, const FieldName& field) {
  CurveTemplate result;
  result.offset = static_cast<std::uint32_t>(value.offset());
  const Dimension metre = dimension_of(UnitKind::length);
  const auto done = [&] {
    scene.curves.push_back(std::move(result));
    return static_cast<int>(scene.curves.size()) - 1;
  };
  if (!value.is(JsonKind::object)) {
    error(value, fmt::format("{} must be a curve such as {{\"circle\": {{\"centre\": [0, 0], \"radius\": 0.1}}}}; this "
                             "is {}",
                             field.text(), describe(value.kind())));
    return done();
  }
  const std::optional<JsonMember> member = only_member(value, curve_keys, field, "curve", diagnostics);
  if (!member) return done();
  const auto key = std::find(curve_keys.begin(), curve_keys.end(), member->name());
  result.kind = static_cast<CurveTemplate::Kind>(key - curve_keys.begin());
  const std::string owner = fmt::format("{} in {}", *key, field.text());
  static constexpr std::array<std::array<std::string_view, 2>, 4> keys{
      {{"centre", "radius"}, {"points", "end"}, {"angle", "radius"}, {"point", "axis"}}};
  const auto& names = keys[static_cast<std::size_t>(result.kind)];
  std::array<JsonValue, 2> v;
  if (!read_members(member->value, names, owner, v, diagnostics)) return done();
  const bool spline = result.kind == CurveTemplate::Kind::spline;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!v[k] && !(spline && k == 1)) error(member->value, fmt::format("{} needs {}", owner, in_quotes(names[k])));
  }
  if (!v[0] || (!v[1] && !spline)) return done();
  const auto pair = [&](std::size_t k, const ExpectedDimension& dimension) {
    const auto numbers_read = numbers.read_pair(v[k], dimension, {names[k], owner});
    result.numbers.insert(result.numbers.end(), numbers_read.begin(), numbers_read.end());
  };
  switch (result.kind) {
    case CurveTemplate::Kind::circle:
      pair(0, metre);
      result.numbers.push_back(numbers.read(v[1], metre, {names[1], owner}));
      break;
    case CurveTemplate::Kind::spline:
      append_pairs(v[0], metre, metre, {names[0], owner}, numbers, result.numbers, diagnostics);
      if (v[1]) {
        static constexpr std::array<std::string_view, 2> words{"natural", "periodic"};
        if (read_word(v[1], words, {names[1], owner}, diagnostics) == 1) result.end = SplineEnd::periodic;
      }
      break;
    case CurveTemplate::Kind::polar: {
      const auto angles = numbers.read_list(v[0], dimension_of(UnitKind::angle), {names[0], owner});
      const auto radii = numbers.read_list(v[1], metre, {names[1], owner});
      if (angles.size() != radii.size()) {
        error(v[1], fmt::format("{}: {} angles, but {} radii", owner, angles.size(), radii.size()));
        break;
      }
      result.numbers = angles;
      result.numbers.insert(result.numbers.end(), radii.begin(), radii.end());
      break;
    }
    case CurveTemplate::Kind::line:
      pair(0, metre);
      pair(1, ExpectedDimension());
      break;
  }
  return done();
}

int SceneReading::table(const JsonValue& value, UnitKind first, UnitKind second, const FieldName& field) {
  TableTemplate result;
  result.offset = static_cast<std::uint32_t>(value.offset());
  append_pairs(value, dimension_of(first), dimension_of(second), field, numbers, result.numbers, diagnostics);
  scene.tables.push_back(std::move(result));
  return static_cast<int>(scene.tables.size()) - 1;
}

}  // namespace catena
