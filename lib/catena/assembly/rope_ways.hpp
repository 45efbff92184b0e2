// Whether the way of a rope lies as it is measured.
//
//   f = straight stretches + R theta,   theta the angle of contact of a pulley: below zero the rope lies beside it,
//
// and its way is shorter than f. Such a rope is slack as long as it can be: f counts only where it holds.
#pragma once

#include "catena/assembly/evaluate.hpp"

namespace catena {

/// Whether a pulley of the rope has an angle of contact below zero at the evaluator's configuration.
bool is_beside_pulley(const Evaluator& evaluator, int rope);

/// A rope of which an end or a pulley is inside the circle of the next one, or at it: a stretch has |h|^2 / D^2 - 1 of
/// less than a hundredth (rope_span.hpp), from where searches do not come nearer, or none
/// that is a number. -1: none.
int rope_at_circle(const Evaluator& evaluator);

/// The largest angle of contact of a rope with a pulley that it slides over, in the given configuration, rad.
double widest_contact(const Model& model, int rope);

}  // namespace catena
