// Designs that a caller gives as a table: the analyses of the scene that are measured become those of a sweep over it.
//
// Analyses without measures are left out, unless a measured one goes on from where they end. Optimisations,
// sensitivities and sweeps choose designs of their own, or ask for derivatives: they have no part in it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/scene/reading/analysis_task.hpp"

namespace catena {

/// Puts the sweep in place of `tasks`: `values` of the parameters `names`, SI, row after row. Returns what is wrong
/// with the table, or that there is nothing to be measured.
std::optional<std::string> sweep_over_given(const std::vector<std::string>& names, std::span<const double> values,
                                            const ParameterTable& parameters, std::vector<AnalysisTask>& tasks);

}  // namespace catena
