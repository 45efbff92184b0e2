// What the list of all kinds of columns (column_kinds.hpp) says of each: what an analysis must compute for it, and the
// names of those that are not of an element.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>

#include "catena/base/unit_kind.hpp"
#include "catena/model/column.hpp"

namespace catena {

enum class ColumnNeed : unsigned char {
  nothing = 0,
  velocities = 1,
  accelerations = velocities | 2,  ///< gamma and the centripetal part want velocities
  rows = 4,                        ///< those of the element, which a plan may leave out
  solved = 8,                      ///< their multipliers
  multipliers = rows | solved,     ///< shows them, or what is derived from them
  sums = 16,                       ///< integrals of power over time
  summed_reaction = rows | sums,
  damping = 32,  ///< valid at rest; includes damping, and laws of velocities, where there are velocities
  masses = 64,
  motion = velocities | masses,
  energies = motion | sums,
  weight = 128,  ///< masses where there is gravity
};

constexpr ColumnNeed need_of(ColumnKind kind) {
  switch (kind) {
#define CATENA_NAMED(kind, name, unit, need, value) \
  case ColumnKind::kind:                            \
    return ColumnNeed::need;
#define CATENA_OF_ELEMENT(kind, need, value) \
  case ColumnKind::kind:                     \
    return ColumnNeed::need;
    CATENA_COLUMN_KINDS(CATENA_NAMED, CATENA_OF_ELEMENT)
#undef CATENA_NAMED
#undef CATENA_OF_ELEMENT
  }
  return ColumnNeed::nothing;
}

/// Whether the column needs all of that.
constexpr bool has_need(ColumnKind kind, ColumnNeed need) {
  const auto wanted = static_cast<unsigned>(need);
  return (static_cast<unsigned>(need_of(kind)) & wanted) == wanted;
}

/// Whether the column shows multipliers, or values derived from them.
constexpr bool is_reaction(ColumnKind kind) { return has_need(kind, ColumnNeed::rows); }

struct NamedKind {
  std::string_view name;
  UnitKind unit;
  ColumnKind kind;
};

#define CATENA_NAMED(kind, name, unit, need, value) {name, UnitKind::unit, ColumnKind::kind},
#define CATENA_OF_ELEMENT(kind, need, value)
inline constexpr NamedKind named_kinds[] = {CATENA_COLUMN_KINDS(CATENA_NAMED, CATENA_OF_ELEMENT)};
#undef CATENA_NAMED
#undef CATENA_OF_ELEMENT

constexpr std::span<const NamedKind> named_kinds_from(ColumnKind first, ColumnKind last) {
  const auto place = [](ColumnKind kind) {
    return std::find_if(std::begin(named_kinds), std::end(named_kinds),
                        [&](const NamedKind& k) { return k.kind == kind; });
  };
  return {place(first), place(last) + 1};
}
inline constexpr std::span<const NamedKind> body_kinds = named_kinds_from(ColumnKind::x, ColumnKind::alpha);
inline constexpr std::span<const NamedKind> energy_kinds = named_kinds_from(ColumnKind::kinetic, ColumnKind::balance);
inline constexpr std::span<const NamedKind> momentum_kinds =
    named_kinds_from(ColumnKind::momentum_x, ColumnKind::angular_momentum);

}  // namespace catena
