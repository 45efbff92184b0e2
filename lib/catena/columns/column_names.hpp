// From the names users write to columns, `crank.tip.vx`, `A.i.fx`, `drive.load`: apps/manual/scenes.md#columns.
//
// Needs the model only, so that a scene's names are checked where they stand, before any plan exists. A bare body,
// point, `A.reaction`, `energy` or `momentum` stands for all of its columns. Time: one hash look-up a name, or a scan
// of the elements for `type#n`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/base/row_sink.hpp"
#include "catena/model/column_rules.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// Why a name is no column, and the names it may have been meant to be, in no order: for a "did you mean".
struct UnknownColumn {
  std::string name;
  std::string message;  ///< a sentence without full stop
  std::vector<std::string> candidates;
};

struct NamedColumn {
  ColumnInfo info;
  Column column;  ///< bodies by their number in the model, -1 for the ground
};

/// Appends the columns that `name` stands for to `out`, or says why there are none.
std::optional<UnknownColumn> find_columns(const Model& model, std::string_view name, std::vector<NamedColumn>& out);

/// The names that are no columns, each with its reason; empty if all are.
std::vector<UnknownColumn> unknown_columns(const Model& model, std::span<const std::string> names);

/// Elements whose reactions, multipliers or loads the names ask for: what PlanOptions::keep_elements wants. Unknown
/// names are passed over.
std::vector<int> elements_with_reactions(const Model& model, std::span<const std::string> names);

/// The default columns: x, y and angle of every body.
std::vector<NamedColumn> default_columns(const Model& model);

}  // namespace catena
