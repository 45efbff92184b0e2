// Functions of time: from JSON to templates.
#include <fmt/format.h>

#include <array>

#include "catena/scene/reading/data_file.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

using Kind = FunctionTemplate::Kind;
constexpr std::array<std::string_view, 7> function_keys{"polynomial", "harmonic", "step",   "law",
                                                        "spline",     "sum",      "product"};
constexpr std::array<std::string_view, 3> end_words{"natural", "clamped", "periodic"};

/// Reads what is under the key of a function of time.
class FunctionData {
 public:
  /// `owner`: what it is called in messages. All must outlive this object.
  FunctionData(SceneReading& reading, const JsonValue& data, const ExpectedDimension& unit, const FieldName& field,
               const std::string& owner, FunctionTemplate& result)
      : reading_(reading), data_(data), unit_(unit), field_(field), owner_(owner), result_(result) {}

  void read_polynomial() {
    if (!is_list_of("coefficients [c0, c1, ...]")) return;
    ExpectedDimension dimension = unit_;
    for (const JsonValue& coefficient : data_.elements()) {
      result_.numbers.push_back(reading_.numbers.read(coefficient, dimension, {"polynomial", field_.text()}));
      if (dimension) dimension = *dimension / second_;
    }
  }
  void read_harmonic() {
    static constexpr std::array<std::string_view, 4> keys{"amplitude", "omega", "phase", "offset"};
    std::array<JsonValue, keys.size()> v;
    if (!read_members(data_, keys, owner_, v, reading_.diagnostics)) return;
    const Dimension radian = dimension_of(UnitKind::angle);
    take(v[0], keys[0], unit_, true);
    take(v[1], keys[1], radian / second_, true);
    take(v[2], keys[2], radian, false);
    take(v[3], keys[3], unit_, false);
  }
  void read_step() {
    static constexpr std::array<std::string_view, 5> keys{"t0", "t1", "from", "to", "order"};
    std::array<JsonValue, keys.size()> v;
    if (!read_members(data_, keys, owner_, v, reading_.diagnostics)) return;
    for (std::size_t k = 0; k < 4; ++k) take(v[k], keys[k], k < 2 ? ExpectedDimension(second_) : unit_, true);
    if (!v[4]) return;
    const bool good = v[4].is(JsonKind::number) && (v[4].number() == 3 || v[4].number() == 5);
    if (!good) reading_.error(v[4], fmt::format("{} must be 3 or 5", FieldName{"order", owner_}.text()));
    if (good) result_.order = static_cast<int>(v[4].number());
  }
  void read_law() {
    static constexpr std::array<std::string_view, 5> keys{"type", "t0", "t1", "from", "to"};
    std::array<JsonValue, keys.size()> v;
    if (!read_members(data_, keys, owner_, v, reading_.diagnostics)) return;
    if (!v[0]) reading_.error(data_, fmt::format("{} needs \"type\"", owner_));
    if (v[0]) {
      if (const int word = read_word(v[0], motion_laws, {"type", owner_}, reading_.diagnostics); word >= 0)
        result_.law = static_cast<MotionLaw>(word);
    }
    for (std::size_t k = 1; k < 5; ++k) take(v[k], keys[k], k < 3 ? ExpectedDimension(second_) : unit_, true);
  }
  void read_spline() {
    static constexpr std::array<std::string_view, 5> keys{"t", "value", "end", "beyond", "points"};
    std::array<JsonValue, keys.size()> v;
    if (!read_members_or_file(data_, keys, 4, owner_, v, reading_.diagnostics)) return;
    if (v[2]) {
      if (const int word = read_word(v[2], end_words, {"end", owner_}, reading_.diagnostics); word >= 0)
        result_.end = static_cast<SplineEnd>(word);
    }
    std::array<std::vector<NumberValue>, 2> lists;
    if (v[4]) {
      if (v[0] || v[1])
        reading_.error(v[4], fmt::format("{} has \"points\", or \"t\" and \"value\", not both", owner_));
      const std::vector<NumberValue> pairs = reading_.pair_list(
          v[4], second_, unit_, {keys[4], owner_}, {.repeats = result_.end == SplineEnd::periodic, .beside = keys});
      for (std::size_t k = 0; k < pairs.size(); ++k) lists[k % 2].push_back(pairs[k]);
    } else {
      for (std::size_t k = 0; k < 2; ++k) {
        if (!v[k]) reading_.error(data_, fmt::format("{} needs {}", owner_, in_quotes(keys[k])));
        if (v[k]) lists[k] = reading_.number_list(v[k], k == 0 ? ExpectedDimension(second_) : unit_, {keys[k], owner_});
      }
    }
    for (const auto& list : lists) result_.numbers.insert(result_.numbers.end(), list.begin(), list.end());
    if (v[0] && v[1] && !lists[0].empty() && !lists[1].empty() && lists[0].size() != lists[1].size()) {
      reading_.error(v[1], fmt::format("{}: {} times, but {} values", owner_, lists[0].size(), lists[1].size()));
      result_.numbers.clear();
    }
    result_.beyond = reading_.beyond(v[3], result_.end, owner_);
  }
  /// Reports anything else than a list with entries.
  bool is_list_of(std::string_view entries) {
    if (data_.is(JsonKind::array) && data_.size() > 0) return true;
    reading_.error(data_, fmt::format("{} must be a list of {}", owner_, entries));
    return false;
  }

 private:
  /// A number by its key; absent ones are 0 unless required.
  void take(const JsonValue& number, std::string_view name, const ExpectedDimension& dimension, bool required) {
    if (number) {
      result_.numbers.push_back(reading_.numbers.read(number, dimension, {name, owner_}));
    } else {
      if (required) reading_.error(data_, fmt::format("{} needs {}", owner_, in_quotes(name)));
      result_.numbers.push_back(required ? NumberValue() : NumberValue::constant(0));
    }
  }

  SceneReading& reading_;
  const JsonValue& data_;
  const ExpectedDimension& unit_;
  const FieldName& field_;
  const std::string& owner_;
  FunctionTemplate& result_;
  const Dimension second_ = dimension_of(UnitKind::time);
};

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
  scene.indirect.functions.push_back(function_object(value, unit, field));
  return static_cast<int>(scene.indirect.functions.size()) - 1;
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
  const std::string owner = fmt::format("{} in {}", *key, field.text());
  FunctionData data(*this, member->value, unit, field, owner, result);
  switch (result.kind) {
    case Kind::constant:
    case Kind::state:  // no function of time: read before
      break;
    case Kind::polynomial:
      data.read_polynomial();
      break;
    case Kind::harmonic:
      data.read_harmonic();
      break;
    case Kind::step:
      data.read_step();
      break;
    case Kind::law:
      data.read_law();
      break;
    case Kind::spline:
      data.read_spline();
      break;
    case Kind::sum:
    case Kind::product:
      if (!data.is_list_of("functions")) break;
      for (const JsonValue& part : member->value.elements()) {
        result.parts.push_back(
            function_part(part, result.kind == Kind::sum ? unit : ExpectedDimension(), {*key, field.text()}));
      }
      break;
  }
  return result;
}

}  // namespace catena
