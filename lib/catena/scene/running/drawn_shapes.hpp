// Shapes of modes and of buckling for a pose sink: the pose about which they are, and each as rates of the plan's
// coordinates, m and rad.
#pragma once

#include <span>
#include <vector>

#include "catena/scene/running/analysis_run.hpp"

namespace catena {

/// Nothing where no drawing is wanted. The evaluator is set to q; `shapes` are over the plan's columns.
void draw_shapes(const AnalysisContext& context, Evaluator& evaluator, double t, std::span<const double> q,
                 const std::vector<std::vector<double>>& shapes);

/// The softest mode about an equilibrium, where the bodies have the masses that a mode needs.
void draw_softest_mode(const AnalysisContext& context);

}  // namespace catena
