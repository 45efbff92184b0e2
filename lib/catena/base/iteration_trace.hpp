// Reports every iteration of a search for a configuration to an observer: shows where Newton's method stagnates or
// jumps.
#pragma once

#include <functional>
#include <string_view>

namespace catena {

/// One iteration: of which method, its number from 1, the residual left (length scales or rad in assembly, N at an
/// equilibrium) and the last change of the configuration (length scales or rad).
using IterationTrace = std::function<void(std::string_view method, int iteration, double residual, double change)>;

}  // namespace catena
