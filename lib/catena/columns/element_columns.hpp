// The columns that an element has, by its type: the part of the name after the first dot, unit, and what it shows.
#pragma once

#include <string>
#include <vector>

#include "catena/base/unit_kind.hpp"
#include "catena/model/column.hpp"
#include "catena/model/model.hpp"

namespace catena {

struct ElementColumn {
  std::string suffix;
  UnitKind unit;
  ColumnKind kind;
  int detail = -1;
  bool in_reaction = false;  ///< one of those that `.reaction` stands for
};

/// All columns of an element, in the order in which they are listed.
std::vector<ElementColumn> columns_of_element(const Model& model, int element);

}  // namespace catena
