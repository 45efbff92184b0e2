// Whether a constraint that an event engages holds where it happens, as it must:
//
//   |Phi(q, t)| <= 1e-6 x length scale, or rad
//
// its value having been moved by whole turns first (engaged_turns.hpp). Units: m, rad.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

/// The rows of an element at q and the evaluator's time.
std::vector<double> residuals_of(Evaluator& evaluator, std::span<const double> q, int element);

/// A report that names the element, the instant and by how much it misses; ok if it holds.
Report check_fit(Evaluator& evaluator, std::span<const double> q, int element);

}  // namespace catena
