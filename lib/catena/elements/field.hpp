// Descriptions of the keys that a scene may set on an element: key, member, unit, doc line, default. From these the
// scene reader, the schema and `catena explain` are derived; elements never see JSON. A field without a doc line is
// reserved: scenes may set it, but no analysis that is built reads it, so that schema and `explain` do not offer it.
#pragma once

#include <string_view>

#include "catena/base/unit_kind.hpp"

namespace catena {

/// Which numbers a field accepts.
enum class Domain { any, positive, not_negative, not_zero };

/// The attachment point on body i (`body` 0) or j (1), local coordinates, from the keys `i`, `j` or `at`.
template <class Member>
struct PointField {
  std::string_view key;
  Member member;
  int body;
  std::string_view doc;
};

/// A direction fixed in body i or j, normalised when read. If `required` is false, complete() supplies it.
template <class Member>
struct AxisField {
  std::string_view key;
  Member member;
  int body;
  bool required;
  std::string_view doc;
};

/// A place in the ground frame.
template <class Member>
struct PlaceField {
  std::string_view key;
  Member member;
  std::string_view doc;
};

/// A number. If `required` is false, or the key `unless` is given in its place, the member's initial value stands.
template <class Member>
struct NumberField {
  std::string_view key;
  Member member;
  UnitKind unit;
  Domain domain;
  bool required;
  std::string_view doc;
  std::string_view unless = {};
};

/// An optional number whose unit is that of the column it bounds: `unit`, or `angle_unit` where that is an angle.
template <class Member>
struct BoundField {
  std::string_view key;
  Member member;
  UnitKind unit, angle_unit;
  Domain domain;
  std::string_view doc;
};

/// The name of a column: where an element without points of its own acts.
struct ColumnField {
  std::string_view key;
  std::string_view doc;
};

/// The pulleys that a rope runs over: a list of objects.
struct PulleysField {
  std::string_view key;
  std::string_view doc;
  static constexpr bool required = true;
};

/// true or false; the member's initial value is the default.
template <class Member>
struct FlagField {
  std::string_view key;
  Member member;
  std::string_view doc;
};

/// +1 or -1.
template <class Member>
struct SideField {
  std::string_view key;
  Member member;
  std::string_view doc;
};

/// One of two words; the member is true for the second, the first is the default.
template <class Member>
struct ChoiceField {
  std::string_view key;
  Member member;
  std::string_view first, second;
  std::string_view doc;
};

/// A plane curve fixed in a body.
template <class Member>
struct CurveField {
  std::string_view key;
  Member member;
  int body;
  std::string_view doc;
};

/// Pairs of numbers, rising in the first.
template <class Member>
struct TableField {
  std::string_view key;
  Member member;
  UnitKind first, second;
  std::string_view doc;
};

/// The default of a function of time. `given`: the value that the element measures in the given configuration, before
/// assembly.
enum class Omitted { refused, zero, given };

/// A function of time: the element's function number `index`.
struct FunctionField {
  std::string_view key;
  int index;
  UnitKind unit;
  Omitted omitted;
  std::string_view doc;
};

/// Two functions of time written as a pair [f_x, f_y]: functions number `index` and `index` + 1.
struct FunctionPairField {
  std::string_view key;
  int index;
  UnitKind unit;
  std::string_view doc;
};

// Deduction guides, so that an element writes PointField{"i", &Type::s_i, 0, "..."} on compilers without C++20's
// deduction for aggregates.
template <class M>
PointField(std::string_view, M, int, std::string_view) -> PointField<M>;
template <class M>
AxisField(std::string_view, M, int, bool, std::string_view) -> AxisField<M>;
template <class M>
PlaceField(std::string_view, M, std::string_view) -> PlaceField<M>;
template <class M>
NumberField(std::string_view, M, UnitKind, Domain, bool, std::string_view) -> NumberField<M>;
template <class M>
NumberField(std::string_view, M, UnitKind, Domain, bool, std::string_view, std::string_view) -> NumberField<M>;
template <class M>
BoundField(std::string_view, M, UnitKind, UnitKind, Domain, std::string_view) -> BoundField<M>;
template <class M>
FlagField(std::string_view, M, std::string_view) -> FlagField<M>;
template <class M>
SideField(std::string_view, M, std::string_view) -> SideField<M>;
template <class M>
ChoiceField(std::string_view, M, std::string_view, std::string_view, std::string_view) -> ChoiceField<M>;
template <class M>
CurveField(std::string_view, M, int, std::string_view) -> CurveField<M>;
template <class M>
TableField(std::string_view, M, UnitKind, UnitKind, std::string_view) -> TableField<M>;

}  // namespace catena
