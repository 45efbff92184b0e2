// A state law: the magnitude of a force as a formula over columns and t.
//
//   F = f(columns(q, qd), t)        "torque": "=-40*(arm.angle - 0.5) - 3*arm.omega"
//
// It stands in the place of one of a force element's functions of time. Its columns show places, velocities and the
// forces of springs, which are known before accelerations are; reactions and accelerations would close a loop. `names`
// are the formula's inputs as they are written; bind_state_laws() (columns/state_laws.hpp) looks them up once the model
// is complete, and no analysis takes a model before that. A law has no potential, whatever it depends on: its power is
// counted as work from outside. Units: N, N m.
#pragma once

#include <string>
#include <vector>

#include "catena/base/formula.hpp"
#include "catena/model/column.hpp"

namespace catena {

template <class S>
struct StateLaw {
  int element = -1;  ///< the force element that it is the magnitude of
  int place = 0;     ///< which of its functions
  Formula<S> formula;
  std::vector<std::string> names;
  std::vector<Column> inputs;  ///< by input of the formula; bodies by their number in the model
};

}  // namespace catena
