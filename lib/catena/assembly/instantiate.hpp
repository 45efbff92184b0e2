// Instantiates everything the library derives from one element type. The build writes a source file per element header
// that includes this one and names the type: an edited element recompiles only its own code.
#pragma once

#include "catena/assembly/constraint_operations.hpp"
#include "catena/assembly/force_operations.hpp"

#define CATENA_INSTANTIATE_CONSTRAINT(Type) template struct catena::ConstraintOperations<catena::Type<double>>;
#define CATENA_INSTANTIATE_FORCE(Type) template struct catena::ForceOperations<catena::Type<double>>;
