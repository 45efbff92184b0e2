// A column of the user's own: a formula over other columns, with a unit that its author gives it.
//
// `inputs` are names as they stand in outputs ("crank.tip.vx", "t", another column of one's own); input k of the
// formula is the column inputs[k]. Names are looked up where the columns of an analysis are resolved, in ColumnSet;
// circles are refused there.
#pragma once

#include <string>
#include <vector>

#include "catena/base/formula.hpp"

namespace catena {

template <class S>
struct OwnColumn {
  std::string name;
  std::string unit;  ///< SI, in the syntax of scenes: "m/s"; empty: a pure number
  Formula<S> formula;
  std::vector<std::string> inputs;
};

}  // namespace catena
