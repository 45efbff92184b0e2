// The analyses of one design, in order: what their measures come to, or why there are none.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "catena/scene/running/analysis_run.hpp"

namespace catena {

/// Gets an analysis of a design that went well; false ends the design.
using TakeAnalysis = std::function<bool(const AnalysisTask& analysis, const AnalysisResult& result)>;

/// Runs the inner analyses of the context's task with other values of parameters, each on a model of its own, until one
/// fails or `take` is false. `design`: derivatives that are wanted, or nullptr; `watch`: who sees rows and poses, or
/// nullptr. Returns the status of the last analysis, `refused` for one that throws; nothing where the scene allows no
/// such model. Nothing of the context changes, so that several threads may ask for designs at once.
std::optional<Status> run_design(const AnalysisContext& context, ParameterSeeds seeds, const DesignRequest* design,
                                 DesignSink* watch, const TakeAnalysis& take);

/// The result of a measure of an analysis; nullptr if it has no value.
const MeasureResult* value_of(const PlacedMeasure& measure, const AnalysisResult& result);

/// run_design(), and its measures in order: NaN for one that has no value. The status is that of the first analysis
/// that failed; `refused` where the scene allows no such model, not_converged where a measure has no value.
Status measure_design(const AnalysisContext& context, const ParameterSeeds& seeds, DesignSink* watch,
                      std::vector<double>& measures);

/// Shows a design whose parameters have these values: runs its analyses once more for who draws.
void show_design(const AnalysisContext& context, const ParameterSeeds& seeds, DesignLabel label,
                 std::unique_ptr<DesignSink> watch);

}  // namespace catena
