// The analyses of one design, in order: what their measures come to, or why there are none.
#pragma once

#include <vector>

#include "catena/scene/running/analysis_run.hpp"

namespace catena {

/// Runs the inner analyses of the context's task with other values of parameters, each on a model of its own, and takes
/// over their measures in order: NaN for one that has no value. The status is that of the first analysis that failed;
/// `refused` where the scene allows no such model, not_converged where a measure has no value. Nothing of the context
/// changes, so that several threads may ask for designs at once.
Status measure_design(const AnalysisContext& context, const ParameterSeeds& seeds, std::vector<double>& measures);

}  // namespace catena
