// Whether a joint has viscous damping of its own, key `c`: it then has a JointDamper, which goes on without the joint.
#pragma once

#include "catena/model/model.hpp"

namespace catena {

/// By the element's number; false for what is no joint with such a key.
bool has_damping(const Model& model, int element);

}  // namespace catena
