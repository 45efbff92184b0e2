// Angle estimates off by whole turns.
//
// A driver may say 370 degrees where the estimate says 10: the same pose, a turn apart. Before anything is solved the
// body is turned by those whole turns, and with it every body whose angle is tied to its own: through angle constraints
// and welds by the same turns, through gears and belts by the turn that meets their equation and changes the pose
// least, by none where the equation does not depend on it. Released constraints are ignored.
#pragma once

#include <span>

#include "catena/assembly/evaluate.hpp"

namespace catena {

/// Moves the angles in q (plan order) by whole turns to the values that angle constraints and drivers prescribe at the
/// evaluator's time. Linear in the number of elements.
void move_whole_turns(const Evaluator& evaluator, std::span<double> q);

}  // namespace catena
