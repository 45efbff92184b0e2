#include "catena/scene/describing/element_description.hpp"

#include <tuple>

#include "catena/elements/all.hpp"

namespace catena {
namespace {

template <class Field>
FieldDescription describe_field(const Field& field) {
  FieldDescription d;
  d.kind = kind_of(field);
  d.key = field.key;
  d.doc = field.doc;
  if constexpr (requires { field.required; }) d.required = field.required;
  if constexpr (requires { field.unless; }) d.unless = field.unless;
  if constexpr (requires { field.unit; }) d.unit = field.unit;
  if constexpr (requires { field.domain; }) d.domain = field.domain;
  if constexpr (requires { field.body; }) d.body = field.body;
  if constexpr (requires { field.omitted; }) {
    d.omitted = field.omitted;
    d.required = field.omitted == Omitted::refused;
  }
  if constexpr (requires { field.angle_unit; }) {
    d.second_unit = field.angle_unit;
    d.required = false;
  }
  if constexpr (requires { field.second; }) {
    if constexpr (std::is_same_v<decltype(field.second), UnitKind>) {
      d.unit = field.first;
      d.second_unit = field.second;
      d.required = false;
    } else {
      d.first_word = field.first;
      d.second_word = field.second;
    }
  }
  if (d.kind == FieldKind::flag || d.kind == FieldKind::side || d.kind == FieldKind::choice) d.required = false;
  return d;
}

template <class E>
ElementDescription describe_element(int number) {
  ElementDescription d;
  d.type = E::type;
  d.summary = E::summary;
  d.equation = E::equation;
  d.number = number;
  d.bodies = E::bodies;
  d.functions = E::functions;
  if constexpr (requires { E::rows; }) {
    d.rows = E::rows;
  } else {
    d.force = true;
  }
  if constexpr (requires { E::one_sided; }) d.force = d.one_sided = true;
  if constexpr (requires { E::second_body_optional; }) d.second_body_optional = E::second_body_optional;
  const auto describe = [&](const auto&... field) { (d.fields.push_back(describe_field(field)), ...); };
  if constexpr (requires { E::keys(); }) {
    d.bodies = 0;
    std::apply(describe, E::keys());
  } else {
    std::apply(describe, E::fields());
  }
  for (FieldDescription& field : d.fields) {
    if (field.kind == FieldKind::point && field.body == 1 && d.second_body_optional) field.required = false;
    if constexpr (requires { E::value_synonym; }) {
      if (field.key == "value") field.synonym = E::value_synonym;
    }
    field.slot = d.slots;
    d.slots += slots_of(field.kind);
  }
  return d;
}

std::vector<ElementDescription> describe_elements() {
  std::vector<ElementDescription> all;
  int number = 0;
#define CATENA_DESCRIBE(Type) all.push_back(describe_element<Type<double>>(number++));
  CATENA_CONSTRAINTS(CATENA_DESCRIBE)
  number = 0;
  CATENA_FORCES(CATENA_DESCRIBE)
  number = 0;
  CATENA_GAPS(CATENA_DESCRIBE)
#undef CATENA_DESCRIBE
  return all;
}

}  // namespace

const FieldDescription* ElementDescription::find(std::string_view key) const {
  for (const FieldDescription& field : fields) {
    if (field.key == key) return &field;
  }
  return nullptr;
}

std::span<const ElementDescription> element_descriptions() {
  static const std::vector<ElementDescription> all = describe_elements();
  return all;
}

const ElementDescription* find_element_type(std::string_view type) {
  for (const ElementDescription& description : element_descriptions()) {
    if (description.type == type) return &description;
  }
  return nullptr;
}

}  // namespace catena
