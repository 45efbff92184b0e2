// Whole turns at the engagement of a constraint: a clutch that closes after some turns holds the present pose, not the
// angle given at the start.
//
//   Phi = angle - c        engaged where Phi = 2 pi k + misfit:   c -> c + 2 pi k, so that no angle jumps
//
// k is the integer that makes |misfit| least. Constraints whose value counts turns of one angle have it:
// absolute_angle, relative_angle, weld, and rack_pinion (turns of the pinion against the rack, 2 pi R each). Gears and
// belts tie two angles by an integral ratio at best: they must be engaged where their equation holds. Units: rad, m.
#pragma once

#include <span>

#include "catena/model/model.hpp"

namespace catena {

/// k of an element whose rows have the residuals `phi`; 0 where its value does not count turns.
int whole_turns_of(const Model& model, int element, std::span<const double> phi);

/// c -> c + 2 pi k; c may be a function of time.
void turn_value(Model& model, int element, int turns);

}  // namespace catena
