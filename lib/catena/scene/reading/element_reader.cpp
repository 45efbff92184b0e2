// Constraints, drivers and forces: from JSON to templates, by the descriptions of their types.
#include <fmt/format.h>

#include <algorithm>
#include <array>

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

/// Where the body's name ends and the point's begins: the first dot outside of braces.
std::size_t find_dot(std::string_view text) {
  int depth = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '{') ++depth;
    if (text[k] == '}') --depth;
    if (text[k] == '.' && depth <= 0) return k;
  }
  return std::string_view::npos;
}

}  // namespace

void SceneReading::attachment(const JsonValue& value, std::string_view key, std::string_view owner, bool has_at,
                              AttachmentTemplate& attachment, NumberValue* local) {
  using Form = AttachmentTemplate::Form;
  const FieldName field{key, owner};
  if (value.is(JsonKind::string)) {
    const std::size_t dot = find_dot(value.text());
    attachment.body = name(value, 0, dot);
    attachment.form = Form::origin;
    if (dot == std::string_view::npos) return;
    attachment.form = Form::point;
    attachment.point = name(value, dot + 1);
    if (has_at) error(value, field.text() + " may not name a point where \"at\" gives the place");
    return;
  }
  const bool list = value.is(JsonKind::array) && value.size() == 2 && value.elements().begin()->is(JsonKind::string);
  if (!list) {
    error(value, fmt::format("{} must be \"body\", \"body.point\" or [\"body\", [x', y']]; this is {}", field.text(),
                             describe(value.kind())));
    return;
  }
  auto element = value.elements().begin();
  const std::string_view text = element->text();
  if (find_dot(text) != std::string_view::npos) {
    error(*element, field.text() + " must name a body without a point, since a place in its frame follows");
  } else {
    attachment.body = name(*element);
    attachment.form = Form::local;
  }
  ++element;
  const auto place = numbers.read_pair(*element, dimension_of(UnitKind::length), field);
  if (local) std::copy(place.begin(), place.end(), local);
  if (has_at) error(value, field.text() + " may not give a place where \"at\" gives it");
}

void SceneReading::element(const JsonValue& object, std::string_view list, BlockTemplate& block) {
  if (!object.is(JsonKind::object)) {
    error(object,
          fmt::format("an entry of \"{}\" must be an object {{...}}; this is {}", list, describe(object.kind())));
    return;
  }
  const JsonValue type_value = object.find("type");
  const ElementDescription* type = read_type(object, type_value, list, diagnostics);
  if (!type) return;

  // Keys: the common ones, then those of the fields; points are read through i and j.
  std::array<std::string_view, most_keys> keys{"type", "name", "i", "at", "j"};
  const bool attached = type->bodies > 0;
  std::size_t count = type->bodies == 2 ? 5 : attached ? 4 : 2;
  std::array<std::size_t, most_keys> key_of_field{};
  for (std::size_t f = 0; f < type->fields.size(); ++f) {
    if (type->fields[f].kind == FieldKind::point) continue;
    key_of_field[f] = count;
    keys[count++] = type->fields[f].key;
  }
  const std::size_t first_synonym = count;
  for (const FieldDescription& field : type->fields) {
    if (!field.synonym.empty()) keys[count++] = field.synonym;
  }
  std::array<JsonValue, most_keys> v;
  const JsonValue named = object.find("name");
  const std::string owner = owner_text(type->type, named);
  read_members(object, std::span(keys).first(count), owner, v, diagnostics);
  const JsonValue at = attached ? v[3] : JsonValue();
  for (std::size_t f = 0, other = first_synonym; f < type->fields.size(); ++f) {
    const FieldDescription& field = type->fields[f];
    if (field.synonym.empty()) continue;
    const JsonValue& synonym = v[other++];
    JsonValue& value = v[key_of_field[f]];
    if (value && synonym)
      error(synonym, fmt::format("{}: {} is another name of {}; give one of them", owner, in_quotes(field.synonym),
                                 in_quotes(field.key)));
    if (!value) value = synonym;
  }

  ElementTemplate element;
  element.offset = static_cast<std::uint32_t>(object.offset());
  element.kind = type->force ? ElementKind::force : list == "drivers" ? ElementKind::driver : ElementKind::constraint;
  element.type = static_cast<short>(type - element_descriptions().data());
  if (named && !read_string(named, {"name", type->type}, diagnostics).data()) {
    // reported
  } else if (named) {
    element.name = name(named);
    if (!element.name.empty() || named.text().empty()) {
      if (const std::string problem = element_name_problem(sample(element.name)); !problem.empty())
        error(named, problem);
    }
  }

  std::array<NumberValue, 2 * most_keys> slots;
  const JsonValue ends[2] = {attached ? v[2] : JsonValue(), type->bodies == 2 ? v[4] : JsonValue()};
  bool bounds_angle = false;
  for (int body = 0; body < type->bodies; ++body) {
    const std::string_view key = body == 0 ? "i" : "j";
    NumberValue* local = nullptr;
    for (const FieldDescription& field : type->fields) {
      if (field.kind == FieldKind::point && field.body == body) local = &slots[static_cast<std::size_t>(field.slot)];
    }
    if (ends[body]) {
      attachment(ends[body], key, owner, static_cast<bool>(at), element.attachment[body], local);
    } else if (body == 0 || !type->second_body_optional) {
      error(object, fmt::format("{} needs {}", owner, in_quotes(key)));
    }
  }

  for (std::size_t f = 0; f < type->fields.size(); ++f) {
    const FieldDescription& field = type->fields[f];
    if (field.kind == FieldKind::point) continue;
    const JsonValue& value = v[key_of_field[f]];
    if (!value) {
      const bool driven = element.kind == ElementKind::driver && field.kind == FieldKind::function;
      if (!field.unless.empty() && object.find(field.unless)) continue;
      const std::string or_else = field.unless.empty() ? "" : " or " + in_quotes(field.unless);
      if (field.required || driven) error(object, fmt::format("{} needs {}{}", owner, in_quotes(field.key), or_else));
      continue;
    }
    element.given |= 1u << f;
    const auto slot = static_cast<std::size_t>(field.slot);
    const FieldName name_of_field{field.key, owner};
    const auto pair = [&](const ExpectedDimension& dimension) {
      const auto read = numbers.read_pair(value, dimension, name_of_field);
      slots[slot] = read[0];
      slots[slot + 1] = read[1];
    };
    const auto index = [&](int number) {
      slots[slot] = NumberValue::constant(number, value.offset());
      element.indirect |= 1u << slot;
    };
    const auto function_at = [&](std::size_t k, const JsonValue& part) {
      int number = type->force ? state_law(part, name_of_field) : -1;
      if (number < 0) number = function(part, dimension_of(field.unit), name_of_field, slots[k]);
      if (number < 0) return;
      slots[k] = NumberValue::constant(number, part.offset());
      element.indirect |= 1u << k;
    };
    switch (field.kind) {
      case FieldKind::point:
        break;
      case FieldKind::axis:
        pair(ExpectedDimension());
        break;
      case FieldKind::place:
        pair(dimension_of(UnitKind::length));
        break;
      case FieldKind::number:
        slots[slot] = numbers.read(value, field.unit, name_of_field);
        break;
      case FieldKind::column:
        if (!value.is(JsonKind::string)) {
          error(value, fmt::format("{} must be the name of a column; this is {}", name_of_field.text(),
                                   describe(value.kind())));
          break;
        }
        element.attachment[0].body = name(value);
        element.attachment[0].form = AttachmentTemplate::Form::origin;
        bounds_angle = value.text().ends_with(".angle");
        break;
      case FieldKind::bound:
        slots[slot] = numbers.read(value, bounds_angle ? field.second_unit : field.unit, name_of_field);
        break;
      case FieldKind::flag:
        slots[slot] = NumberValue::constant(read_flag(value, name_of_field, diagnostics) ? 1 : 0, value.offset());
        break;
      case FieldKind::side: {
        const bool good = value.is(JsonKind::number) && (value.number() == 1 || value.number() == -1);
        if (!good) error(value, name_of_field.text() + " must be 1 or -1");
        slots[slot] = NumberValue::constant(good ? value.number() : 1, value.offset());
        break;
      }
      case FieldKind::choice: {
        const std::array words{field.first_word, field.second_word};
        slots[slot] =
            NumberValue::constant(read_word(value, words, name_of_field, diagnostics) == 1 ? 1 : 0, value.offset());
        break;
      }
      case FieldKind::curve:
        index(curve(value, name_of_field));
        break;
      case FieldKind::table:
        index(table(value, field.unit, field.second_unit, name_of_field));
        break;
      case FieldKind::pulleys:
        index(pulleys(value, name_of_field));
        break;
      case FieldKind::function:
        function_at(slot, value);
        break;
      case FieldKind::function_pair: {
        if (!value.is(JsonKind::array) || value.size() != 2) {
          error(value, name_of_field.text() + " must be a list of two functions [f_x, f_y]");
          break;
        }
        auto part = value.elements().begin();
        function_at(slot, *part);
        ++part;
        function_at(slot + 1, *part);
        break;
      }
    }
  }
  element.first_number = keep(std::span(slots).first(static_cast<std::size_t>(type->slots)));
  if (at) {
    element.has_at = true;
    keep(numbers.read_pair(at, dimension_of(UnitKind::length), {"at", owner}));
  }
  block.elements.push_back(element);
}

}  // namespace catena
