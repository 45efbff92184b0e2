// A table of the scene's own, a function in its expressions: the spline through its points.
//
//   "tables": {"p": {"x": [0, 1, 2], "y": [0, 3, "=2*peak"], "end": "natural", "beyond": "hold"}} "=p(crank.angle)"
//
// Its entries are numbers, and may depend on parameters, but not on tables. It is made anew for every set of
// parameters, with derivatives where these carry some. x and y have no units of their own: what they mean is up to the
// expressions.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "catena/scene/json/json_document.hpp"
#include "catena/scene/numbers/number_value.hpp"

namespace catena {

struct TableFunction {
  std::string name;
  SplineEnd end = SplineEnd::natural;
  Beyond beyond = Beyond::error;
  std::vector<NumberValue> x, y;
  JsonValue place{};
};

/// Throws std::invalid_argument for points that define no spline, and ExpressionError for an entry without a value.
template <class S>
typename Formula<S>::Table make_table(const TableFunction& table, const ExpressionPool& pool,
                                      std::span<const S> parameters) {
  std::vector<S> x, y;
  for (const NumberValue& number : table.x) x.push_back(evaluate<S>(number, pool, parameters, {}));
  for (const NumberValue& number : table.y) y.push_back(evaluate<S>(number, pool, parameters, {}));
  return std::make_shared<const NamedTable<S>>(NamedTable<S>{table.name, Spline<S>(x, y, table.end, table.beyond)});
}

/// The same, null for one that cannot be made: the model's builder reports it.
template <class S>
typename Formula<S>::Table try_to_make(const TableFunction& table, const ExpressionPool& pool,
                                       std::span<const S> parameters) {
  try {
    return make_table<S>(table, pool, parameters);
  } catch (const std::invalid_argument&) {
  } catch (const ExpressionError&) {
  }
  return nullptr;
}

}  // namespace catena
