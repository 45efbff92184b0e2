// Keys of contacts, stops and joint friction that have no effect beside the others, so that what their owner meant does
// not happen: damping without a stiffness, a restitution of what is elastic, a static coefficient of smoothed friction.
#pragma once

#include <string>
#include <vector>

#include "catena/model/model.hpp"

namespace catena {

/// A sentence for each element that has such keys, at most five.
std::vector<std::string> keys_without_effect(const Model& model);

}  // namespace catena
