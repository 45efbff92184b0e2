// Which columns the formulas of own columns read, looked up and checked.
//
//   "speed": sqrt(rod.pen.vx^2 + rod.pen.vy^2)    =>    inputs[speed] = {vx of rod.pen, vy of rod.pen}
//
// A formula may read other own columns, but not, through them, itself. Each of its names must stand for one column.
#pragma once

#include <optional>
#include <vector>

#include "catena/columns/column_names.hpp"

namespace catena {

/// By number of the own column, those of the model and behind them its laws of state: the columns that its formula
/// reads, in the order of its inputs.
using OwnInputs = std::vector<std::vector<Column>>;

/// Looks up what own column number `own` reads, and what those read that it reads; `inputs` has a place for every own
/// column of the model. Nothing, or why one of the names is no column that a formula can read, with that name.
std::optional<UnknownColumn> find_own_inputs(const Model& model, int own, OwnInputs& inputs);

/// The formula of an own column or, behind them, of a law of state.
template <class S>
const Formula<S>& formula_of(const BasicModel<S>& model, int own) {
  const auto k = static_cast<std::size_t>(own), count = model.own_columns.size();
  return k < count ? model.own_columns[k].formula : model.laws[k - count].formula;
}

/// Calls f(column) for every column that is no own one among those that `column` shows or is made of.
template <class F>
void visit_read_columns(const OwnInputs& inputs, const Column& column, F&& f) {
  if (column.kind != ColumnKind::own) return f(column);
  for (const Column& input : inputs[static_cast<std::size_t>(column.index)]) visit_read_columns(inputs, input, f);
}

}  // namespace catena
