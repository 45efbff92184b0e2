// Whether ropes go round their pulleys as their owner is likely to mean: an angle of contact is not negative, so that a
// rope given beside a pulley that it has on the wrong side is taken to go round it, by a whole turn less that angle.
#pragma once

#include <string>
#include <vector>

#include "catena/model/model.hpp"

namespace catena {

/// A sentence for each rope that winds more than three quarters of a turn round a pulley as given, at most five.
std::vector<std::string> ropes_in_loops(const Model& model);

}  // namespace catena
