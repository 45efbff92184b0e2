// Checks that a model's functions of time are defined for a whole run: tables and user-defined functions may end.
//
// Called once before a run, so that nothing throws inside it. Units: s.
#pragma once

#include "catena/base/status.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// `refused`, naming the element whose function does not cover `run`, and what it covers.
Report check_time_functions(const Model& model, const TimeRange& run);

}  // namespace catena
