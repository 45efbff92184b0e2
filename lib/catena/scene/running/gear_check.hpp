// Whether gears can mesh: their centres must be as far apart as their pitch radii say.
//
//   |h| = R_i + R_j (external),  |R_i - R_j| (internal),   h = r_Pj - r_Pi, m
//
// The gear equation does not contain this condition, since other joints hold the centres; where it is violated a radius
// or a bearing is wrong, and so is the motion.
#pragma once

#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

/// A sentence for each gear that does not fit at the evaluator's configuration, at most five.
std::vector<std::string> gears_that_do_not_fit(const Evaluator& evaluator);

}  // namespace catena
