// The length that places, errors and rates of a scene are compared with where no joint tells one: the extent of the
// given bodies, else the mean arm of forces, the mean size of curves, the mean radius of gyration, the size of
// one-sided elements, the distances that constraints keep and free lengths of springs, the way v^2 / g in which weight
// stops what moves, else 1; in dynamics that is then the way of the motion itself (analysis/motion/way_of_motion.hpp),
// at rest the way on which forces change (analysis/balance/way_of_forces.hpp). Units: m.
#pragma once

#include "catena/model/model.hpp"

namespace catena {

double length_without_joints(const Model& model);
/// The same, but 0 where nothing gives a length.
double given_length(const Model& model);

class Equations;
/// Whether nothing in the scene gives a length: neither joints, nor bodies, nor what acts on them.
bool lacks_length(const Equations& equations);

}  // namespace catena
