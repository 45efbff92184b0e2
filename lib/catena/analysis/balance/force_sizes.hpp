// The sizes of the applied forces at every coordinate before they cancel, at rest.
//
//   all_c = sum over gravity and all force elements of |their part of Q_c|,   loads_c: gravity, forces, torques alone
//
// Used to measure rounding in Q, and to find the loads where springs balance each other. N, N m.
#pragma once

#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

struct ForceSizes {
  std::vector<double> all, loads;  ///< all coordinates, plan order
};

/// At the evaluator's configuration and time.
ForceSizes force_sizes(const Evaluator& evaluator);

}  // namespace catena
