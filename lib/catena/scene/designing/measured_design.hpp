// Analyses inside of others (sensitivity, optimise, sweep), with other values of parameters: one, or all of a design in
// order, and what their measures come to, or why there are none.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "catena/scene/running/analysis_run.hpp"

namespace catena {

/// How an inner analysis is to be run.
struct InnerRun {
  const ParameterSeeds& seeds;  ///< values of parameters besides those of its table
  SystemState& state;           ///< where it starts; it leaves behind where it ended
  RowSink& rows;
  const DesignRequest* design = nullptr;  ///< derivatives that are wanted, or nullptr
  bool is_shown = false;                  ///< its progress and iterations are reported like those of the outer analysis
  PoseSink* poses = nullptr;              ///< nullptr: nothing is drawn
  ParameterSeeds values_at_end{};         ///< what it leaves to the next, as AnalysisContext has it
  bool went_back = false;                 ///< gradients were found by adjoints
  bool adjoint_failed = false;            ///< they were not, and the analysis was run once more
};

/// By inner analysis, in the order of the task: how often adjoints led to gradients less how often they did not, of the
/// designs so far. Below zero they are not tried again: derivatives are carried forward at once.
using AdjointRecord = std::vector<int>;

/// Runs an inner analysis on a model of its own, once more where gradients by adjoints turn out not to exist, to carry
/// them forward; `refused`, with the message, for one that throws. Its gradients are
/// those of its equations alone (missing_derivatives.hpp). Returns false, with the reason as message, where the scene
/// allows no such analysis. Nothing of `outer` changes.
bool run_inner(const AnalysisContext& outer, const AnalysisTask& inner, InnerRun& run, AnalysisResult& result);

/// Gets an analysis of a design that went well; false ends the design.
using TakeAnalysis = std::function<bool(const AnalysisTask& analysis, const AnalysisResult& result)>;

/// Runs the inner analyses of the context's task with other values of parameters, each on a model of its own, until one
/// fails or `take` is false. `design`: derivatives that are wanted, or nullptr; `watch`: gets rows and poses, or
/// nullptr. Returns the status of the last analysis, `refused` for one that throws; nothing where the scene allows no
/// such model; `why` gets the reason of either. `record`, if it is given, is used and kept. Nothing of the context
/// changes, so that several threads may ask for designs at once.
std::optional<Status> run_design(const AnalysisContext& context, ParameterSeeds seeds, const DesignRequest* design,
                                 DesignSink* watch, const TakeAnalysis& take, std::string* why = nullptr,
                                 AdjointRecord* record = nullptr);

/// The result of a measure of an analysis; nullptr if it has no value.
const MeasureResult* value_of(const PlacedMeasure& measure, const AnalysisResult& result);

/// run_design(), and its measures in order: NaN for one that has no value. The status is that of the first analysis
/// that failed; `refused` where the scene allows no such model, not_converged where a measure has no value. `why`: the
/// reason of any but ok.
Status measure_design(const AnalysisContext& context, const ParameterSeeds& seeds, DesignSink* watch,
                      std::vector<double>& measures, std::string& why);

/// Shows a design whose parameters have these values: runs its analyses once more for the drawing.
void show_design(const AnalysisContext& context, const ParameterSeeds& seeds, DesignLabel label,
                 std::unique_ptr<DesignSink> watch);

}  // namespace catena
