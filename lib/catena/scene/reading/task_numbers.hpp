// Numbers of an analysis that depend on parameters: "until": "=T", the value of an event, the points of a path.
//
// A task holds its numbers for the parameters that it was read with. A sweep, an optimisation, a path that hands its
// parameter on give these other values: the numbers follow. Constants, nearly all of them, are not kept here.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "catena/scene/reading/analysis_task.hpp"

namespace catena {

/// Why a number is none that the key may have, as "must be above zero; it is -3"; nothing if it may. NaN fits every
/// domain: its error was reported already.
std::optional<std::string> out_of_key(const AnalysisKey& key, double value);

/// Gives the numbers of the task their values for these parameters, all of the scene's. Returns why one has none that
/// its key may have: the analysis cannot be made there.
std::optional<std::string> evaluate_numbers(AnalysisTask& task, const ExpressionPool& expressions,
                                            std::span<const double> parameters);

/// Why `task` asks for an absurd number of rows; nothing if it does not.
std::optional<std::string> too_many_rows(const AnalysisTask& task);

}  // namespace catena
