// What an event has released, of elements without equations.
#pragma once

#include <vector>

#include "catena/model/model.hpp"

namespace catena {

/// Of these elements those that do not come and go by themselves, as one-sided ones, friction and pieces of ropes do;
/// ascending.
std::vector<int> released_by_events(const Model& model, std::vector<int> elements);

}  // namespace catena
