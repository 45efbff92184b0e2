// Whether the way of a rope lies as it is measured.
//
//   f = straight stretches + R theta,   theta the angle of contact of a pulley: below zero the rope lies beside it,
//
// and runs past it (rope_routes.hpp). Here: what searches and checks ask of the way that a model has.
#pragma once

#include "catena/assembly/evaluate.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {

/// The frames of the bodies that a route passes, by node, at the evaluator's configuration.
std::vector<Frame<double>> frames_of(const Evaluator& evaluator, const RopeRoute& route);

/// A rope of which an end or a pulley is inside the circle of the next one, or at it: a stretch has |h|^2 / D^2 - 1 of
/// less than a hundredth (rope_span.hpp), from where searches do not come nearer, or none
/// that is a number. -1: none.
int rope_at_circle(const Evaluator& evaluator);

/// The largest angle of contact of a rope with a pulley that it slides over, in the given configuration, rad.
double widest_contact(const Model& model, int rope);

}  // namespace catena
