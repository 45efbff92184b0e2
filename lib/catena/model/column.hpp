// One column of results, resolved: what it shows, of which body or element. Eight bytes and a half dozen more, because
// a scene of a million links has three million of them.
//
// The kinds are those of column_kinds.hpp, their names in a scene those of apps/manual/scenes.md#columns.
#pragma once

#include "catena/model/column_kinds.hpp"

namespace catena {

#define CATENA_KIND(kind, ...) kind,
enum class ColumnKind : unsigned char { CATENA_COLUMN_KINDS(CATENA_KIND, CATENA_KIND) };
#undef CATENA_KIND

/// Whether the column shows the place, velocity or acceleration of a body or its point.
constexpr bool is_body_column(ColumnKind kind) { return kind >= ColumnKind::x && kind <= ColumnKind::alpha; }

/// Which body a reaction acts on, and in which axes it is given.
enum ReactionSide : int {
  on_j = 0,           ///< ground axes; on the only body of an absolute constraint
  on_i = 1,           ///< ground axes
  on_j_in_joint = 2,  ///< axes of the joint: along axis_i and across it, or those of body i where there is no axis
};

struct Column {
  ColumnKind kind;
  int index = -1;
  int detail = -1;

  friend bool operator==(const Column&, const Column&) = default;
};

}  // namespace catena
