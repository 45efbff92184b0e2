// Bodies whose weight an analysis at rest leaves out because their mass is not given.
#pragma once

#include <string>

#include "catena/assembly/plan.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// A remark that names the moving bodies without a mass where there is gravity; empty: there are none. A mass of zero
/// that is given is meant.
std::string remark_on_weightless(const Model& model, const Plan& plan);

}  // namespace catena
