// Friction of joints whose reaction is not unique, as that of a pin which another pin repeats: what presses the joint,
// and so its friction, is not determined by statics. Such a scene has no answer in any analysis with friction.
#pragma once

#include <span>

#include "catena/base/status.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// `refused`, naming the friction and the joint, if the reaction of a joint with friction is among the `ambiguous`
/// elements (minimum_norm.hpp), ascending. In a motion places that close or stick at t, s, may share the load of a
/// joint that no constraint repeats: they are named.
Report refuse_unclear_friction(const Model& model, std::span<const int> ambiguous, double t);

}  // namespace catena
