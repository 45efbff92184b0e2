// Constraints, drivers and forces: from JSON to templates, by the descriptions of their types.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "catena/scene/describing/element_description.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/name_rules.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

constexpr std::size_t most_keys = 32;

/// `revolute "A"`, or the type alone for an element without a name.
std::string owner_text(std::string_view type, const JsonValue& name) {
  if (name && name.is(JsonKind::string)) return fmt::format("{} {}", type, in_quotes(name.text()));
  return std::string(type);
}

/// Whether a type may stand in a list, "constraints", "drivers" or "forces"; else why not.
std::string wrong_list(const ElementDescription& type, std::string_view list) {
  const auto belongs = [&](std::string_view other) {
    return fmt::format("{} is a {}: it belongs in \"{}\"", type.type, type.force ? "force" : "constraint", other);
  };
  if (list == "forces") return type.force ? "" : belongs("constraints");
  if (type.force) return belongs("forces");
  if (list == "drivers" && !type.can_be_driven())
    return fmt::format("{} has no value that could be driven: a driver is a constraint with one equation and a value",
                       type.type);
  return {};
}

/// The type named by the key `type`, or nullptr with a report.
const ElementDescription* read_type(const JsonValue& object, const JsonValue& type, std::string_view list,
                                    Diagnostics& diagnostics) {
  if (!type) {
    report(object, fmt::format("an entry of \"{}\" needs a \"type\"", list), diagnostics);
    return nullptr;
  }
  const std::string_view text = read_string(type, {"type"}, diagnostics);
  if (!type.is(JsonKind::string)) return nullptr;
  const ElementDescription* found = find_element_type(text);
  if (!found) {
    NearMiss near(text);
    for (const ElementDescription& d : element_descriptions()) {
      if (wrong_list(d, list).empty()) near.consider(d.type);
    }
    if (near.best().empty()) {
      for (const ElementDescription& d : element_descriptions()) near.consider(d.type);
    }
    report(type, fmt::format("unknown type {} in \"{}\"{}", in_quotes(text), list, near.hint()), diagnostics);
    return nullptr;
  }
  if (const std::string problem = wrong_list(*found, list); !problem.empty()) {
    report(type, problem, diagnostics);
    return nullptr;
  }
  return found;
}

/// The reading of one element: its keys, its ends, its fields.
class ElementReading {
 public:
  ElementReading(SceneReading& reading, const JsonValue& object, const ElementDescription& type, std::string_view list)
      : reading_(reading), object_(object), type_(type) {
    element_.offset = static_cast<std::uint32_t>(object.offset());
    element_.kind = type.force ? ElementKind::force : list == "drivers" ? ElementKind::driver : ElementKind::constraint;
    element_.type = static_cast<short>(&type - element_descriptions().data());
  }

  void read(BlockTemplate& block) {
    const std::size_t errors = reading_.diagnostics.count();
    find_members();
    read_name();
    read_ends();
    for (std::size_t f = 0; f < type_.fields.size(); ++f) {
      const FieldDescription& field = type_.fields[f];
      if (field.kind == FieldKind::point) continue;
      if (const JsonValue& value = values_[key_of_field_[f]]) {
        element_.given |= 1u << f;
        read_field(field, value);
      } else {
        check_absent(field);
      }
    }
    element_.first_number = reading_.keep(std::span(slots_).first(static_cast<std::size_t>(type_.slots)));
    if (place_) {
      element_.has_at = true;
      reading_.keep(reading_.numbers.read_pair(place_, dimension_of(UnitKind::length), {"at", owner_}));
    }
    element_.faulty = reading_.diagnostics.count() > errors;
    block.elements.push_back(element_);
  }

 private:
  bool is_attached() const { return type_.bodies > 0; }

  /// The values of all keys: the common ones, then those of the fields; points are read through i and j. A synonym
  /// stands for its field.
  void find_members() {
    std::array<std::string_view, most_keys> keys{"type", "name", "i", "at", "j"};
    std::size_t count = type_.bodies == 2 ? 5 : is_attached() ? 4 : 2;
    for (std::size_t f = 0; f < type_.fields.size(); ++f) {
      if (type_.fields[f].kind == FieldKind::point) continue;
      key_of_field_[f] = count;
      keys[count++] = type_.fields[f].key;
    }
    std::size_t synonym_place = count;
    for (const FieldDescription& field : type_.fields) {
      if (!field.synonym.empty()) keys[count++] = field.synonym;
    }
    owner_ = owner_text(type_.type, object_.find("name"));
    read_members(object_, std::span(keys).first(count), owner_, values_, reading_.diagnostics);
    if (is_attached()) place_ = values_[3];
    for (std::size_t f = 0; f < type_.fields.size(); ++f) {
      const FieldDescription& field = type_.fields[f];
      if (field.synonym.empty()) continue;
      const JsonValue& synonym = values_[synonym_place++];
      JsonValue& value = values_[key_of_field_[f]];
      if (value && synonym)
        reading_.error(synonym, fmt::format("{}: {} is another name of {}; give one of them", owner_,
                                            in_quotes(field.synonym), in_quotes(field.key)));
      if (!value) value = synonym;
    }
  }

  void read_name() {
    const JsonValue named = object_.find("name");
    if (!named || !read_string(named, {"name", type_.type}, reading_.diagnostics).data()) return;
    element_.name = reading_.name(named);
    if (element_.name.empty() && !named.text().empty()) return;
    if (const std::string problem = element_name_problem(reading_.sample(element_.name)); !problem.empty())
      reading_.error(named, problem);
  }

  void read_ends() {
    const JsonValue ends[2] = {is_attached() ? values_[2] : JsonValue(), type_.bodies == 2 ? values_[4] : JsonValue()};
    for (int body = 0; body < type_.bodies; ++body) {
      const std::string_view key = body == 0 ? "i" : "j";
      NumberValue* local = nullptr;
      for (const FieldDescription& field : type_.fields) {
        if (field.kind == FieldKind::point && field.body == body) local = &slots_[static_cast<std::size_t>(field.slot)];
      }
      if (ends[body]) {
        reading_.attachment(ends[body], key, owner_, static_cast<bool>(place_), element_.attachment[body], local);
      } else if (body == 0 || !type_.second_body_optional) {
        reading_.error(object_, fmt::format("{} needs {}", owner_, in_quotes(key)));
      }
    }
  }

  void check_absent(const FieldDescription& field) {
    const bool driven = element_.kind == ElementKind::driver && field.kind == FieldKind::function;
    if (!field.unless.empty() && object_.find(field.unless)) return;
    const std::string or_else = field.unless.empty() ? "" : " or " + in_quotes(field.unless);
    if (field.required || driven)
      reading_.error(object_, fmt::format("{} needs {}{}", owner_, in_quotes(field.key), or_else));
  }

  void read_field(const FieldDescription& field, const JsonValue& value) {
    const FieldName name{field.key, owner_};
    NumberValue& slot = slots_[static_cast<std::size_t>(field.slot)];
    switch (field.kind) {
      case FieldKind::point:
        break;
      case FieldKind::axis:
        read_pair(field, value, ExpectedDimension());
        break;
      case FieldKind::place:
        read_pair(field, value, dimension_of(UnitKind::length));
        break;
      case FieldKind::number:
        slot = reading_.numbers.read(value, field.unit, name);
        break;
      case FieldKind::column:
        read_column(name, value);
        break;
      case FieldKind::bound:
        slot = reading_.numbers.read(value, bounds_angle_ ? field.second_unit : field.unit, name);
        break;
      case FieldKind::flag:
        slot = NumberValue::constant(read_flag(value, name, reading_.diagnostics) ? 1 : 0, value.offset());
        break;
      case FieldKind::side: {
        const bool good = value.is(JsonKind::number) && (value.number() == 1 || value.number() == -1);
        if (!good) reading_.error(value, name.text() + " must be 1 or -1");
        slot = NumberValue::constant(good ? value.number() : 1, value.offset());
        break;
      }
      case FieldKind::choice: {
        const std::array words{field.first_word, field.second_word};
        const bool second = read_word(value, words, name, reading_.diagnostics) == 1;
        slot = NumberValue::constant(second ? 1 : 0, value.offset());
        break;
      }
      case FieldKind::curve:
        refer(field.slot, value, reading_.curve(value, name));
        break;
      case FieldKind::table:
        refer(field.slot, value, reading_.table(value, field.unit, field.second_unit, name));
        break;
      case FieldKind::pulleys:
        refer(field.slot, value, reading_.pulleys(value, name));
        break;
      case FieldKind::function:
        read_function(field, field.slot, value);
        break;
      case FieldKind::function_pair:
        read_functions(field, value);
        break;
    }
  }

  void read_pair(const FieldDescription& field, const JsonValue& value, const ExpectedDimension& dimension) {
    const auto read = reading_.numbers.read_pair(value, dimension, {field.key, owner_});
    std::copy(read.begin(), read.end(), slots_.begin() + field.slot);
  }

  void read_column(const FieldName& name, const JsonValue& value) {
    if (!value.is(JsonKind::string)) {
      reading_.error(value,
                     fmt::format("{} must be the name of a column; this is {}", name.text(), describe(value.kind())));
      return;
    }
    element_.attachment[0].body = reading_.name(value);
    element_.attachment[0].form = AttachmentTemplate::Form::origin;
    bounds_angle_ = value.text().ends_with(".angle");
  }

  /// The slot holds the number of something in a list of the scene.
  void refer(int slot, const JsonValue& value, int number) {
    slots_[static_cast<std::size_t>(slot)] = NumberValue::constant(number, value.offset());
    element_.indirect |= 1u << slot;
  }

  /// A law of state, which forces alone may follow, a function of time, or a plain number.
  void read_function(const FieldDescription& field, int slot, const JsonValue& value) {
    const FieldName name{field.key, owner_};
    int number = type_.force ? reading_.state_law(value, name) : -1;
    NumberValue& plain = slots_[static_cast<std::size_t>(slot)];
    if (number < 0) number = reading_.function(value, dimension_of(field.unit), name, plain);
    if (number >= 0) refer(slot, value, number);
  }

  void read_functions(const FieldDescription& field, const JsonValue& value) {
    if (!value.is(JsonKind::array) || value.size() != 2) {
      reading_.error(value, FieldName{field.key, owner_}.text() + " must be a list of two functions [f_x, f_y]");
      return;
    }
    int slot = field.slot;
    for (const JsonValue& part : value.elements()) read_function(field, slot++, part);
  }

  SceneReading& reading_;
  const JsonValue& object_;
  const ElementDescription& type_;
  ElementTemplate element_;
  std::string owner_;
  JsonValue place_;  // "at"
  std::array<JsonValue, most_keys> values_;
  std::array<std::size_t, most_keys> key_of_field_{};
  std::array<NumberValue, 2 * most_keys> slots_;
  bool bounds_angle_ = false;  // the column that a bound is about is an angle
};

}  // namespace

void SceneReading::element(const JsonValue& object, std::string_view list, BlockTemplate& block) {
  if (!object.is(JsonKind::object)) {
    error(object,
          fmt::format("an entry of \"{}\" must be an object {{...}}; this is {}", list, describe(object.kind())));
    return;
  }
  const ElementDescription* type = read_type(object, object.find("type"), list, diagnostics);
  if (type) ElementReading(*this, object, *type, list).read(block);
}

}  // namespace catena
