// Whether a model may take the place of another one under the same plan: other values, but the same bodies and
// elements. Errors: std::invalid_argument, naming what differs.
#pragma once

#include <cstddef>

#include "catena/assembly/plan.hpp"

namespace catena {

/// `what`: a plural noun.
void require_same_count(std::size_t plan, std::size_t model, const char* what);
/// Throws where the elements of `model` differ in type or bodies from those of `known`. Elements that do not hold for
/// the time being may change their bodies, as ropes do that meet or leave a pulley.
void require_same_structure(const Model& known, const Model& model, const Plan& plan);

}  // namespace catena
