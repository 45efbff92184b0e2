// Descriptions of the element types as plain data, made once from the lists and the fields of the types, so that
// reader, schema and explain are written once for all types.
//
// A scene's element keeps its fields as numbers in slots: one slot a number, two for a point or an axis, in the order
// of the fields. The same layout is known at compile time where the members of a type are filled (element_filler.hpp).
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "catena/elements/field.hpp"

namespace catena {

enum class FieldKind {
  point,
  axis,
  place,
  number,
  bound,
  column,
  flag,
  side,
  choice,
  curve,
  table,
  pulleys,
  function,
  function_pair
};

struct FieldDescription {
  FieldKind kind = FieldKind::number;
  std::string_view key, doc;
  int slot = 0;                   ///< the first of the element's slots that belong to it
  std::string_view synonym = {};  ///< another name of the key
  bool required = true;
  std::string_view unless;  ///< a key that may stand in place of a required one
  UnitKind unit = UnitKind::none,
           second_unit = UnitKind::none;  ///< of a table's second numbers; of a bound on an angle
  Domain domain = Domain::any;
  Omitted omitted = Omitted::refused;
  std::string_view first_word, second_word;  ///< of a choice
  int body = 0;                              ///< of a point, axis or curve: 0 on i, 1 on j

  /// Accepted, but used by no analysis: not offered by schema and explain.
  bool reserved() const { return doc.empty(); }
};

struct ElementDescription {
  std::string_view type, summary, equation;
  bool force = false;                       ///< listed among the forces
  bool one_sided = false;                   ///< a gap: listed there, with equations like a constraint's
  int number = 0;                           ///< in the list of constraint types, or of force types
  int rows = 0, bodies = 1, functions = 0;  ///< bodies: 0 where a column says which
  bool second_body_optional = false;
  int slots = 0;
  std::vector<FieldDescription> fields;

  /// Whether its value may be a function of time in the list of drivers.
  bool can_be_driven() const { return !force && rows == 1 && functions == 1; }
  /// Whether both of its ends may be on one body: what lies between them is.
  bool may_return() const { return find("over") != nullptr; }
  const FieldDescription* find(std::string_view key) const;
};

/// All types: constraints in the order of their list, then forces, then one-sided ones.
std::span<const ElementDescription> element_descriptions();
/// The type of this name, or nullptr.
const ElementDescription* find_element_type(std::string_view type);

/// How many slots a field takes.
constexpr int slots_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::point:
    case FieldKind::axis:
    case FieldKind::place:
    case FieldKind::function_pair:
      return 2;
    default:
      return 1;
  }
}

template <class M>
constexpr FieldKind kind_of(const PointField<M>&) {
  return FieldKind::point;
}
template <class M>
constexpr FieldKind kind_of(const AxisField<M>&) {
  return FieldKind::axis;
}
template <class M>
constexpr FieldKind kind_of(const PlaceField<M>&) {
  return FieldKind::place;
}
template <class M>
constexpr FieldKind kind_of(const NumberField<M>&) {
  return FieldKind::number;
}
template <class M>
constexpr FieldKind kind_of(const BoundField<M>&) {
  return FieldKind::bound;
}
constexpr FieldKind kind_of(const ColumnField&) { return FieldKind::column; }
constexpr FieldKind kind_of(const PulleysField&) { return FieldKind::pulleys; }
template <class M>
constexpr FieldKind kind_of(const FlagField<M>&) {
  return FieldKind::flag;
}
template <class M>
constexpr FieldKind kind_of(const SideField<M>&) {
  return FieldKind::side;
}
template <class M>
constexpr FieldKind kind_of(const ChoiceField<M>&) {
  return FieldKind::choice;
}
template <class M>
constexpr FieldKind kind_of(const CurveField<M>&) {
  return FieldKind::curve;
}
template <class M>
constexpr FieldKind kind_of(const TableField<M>&) {
  return FieldKind::table;
}
constexpr FieldKind kind_of(const FunctionField&) { return FieldKind::function; }
constexpr FieldKind kind_of(const FunctionPairField&) { return FieldKind::function_pair; }

}  // namespace catena
