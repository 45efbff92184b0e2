// Whether all that jumps at an instant moves together.
//
// The rate of an instant follows from a function's two sides there (moving_instants.hpp), which do not tell one jump
// from two of the parts of a sum that happen to meet: those move apart with the parameters, and what is made of the
// function has other values between them. The functions with a parameter moved a little show it: no jump may be left
// within the neighbourhood but at the place where the rate puts it. Units: s.
#pragma once

#include <vector>

#include "catena/base/time_function.hpp"

namespace catena {

/// `moved`: the functions of a model with another value of a parameter, by which the instant t comes to t + by.
bool jumps_together(const std::vector<TimeFunction<double>>& moved, double t, double by);

}  // namespace catena
