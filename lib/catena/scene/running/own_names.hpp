// Columns that an analysis has whatever outputs are named: the parameter of a path, the measures of a sweep;
// derivatives, which it has of its outputs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "catena/scene/numbers/parameter_names.hpp"
#include "catena/scene/reading/analysis_task.hpp"

namespace catena {

/// The column of which `name` is the derivative, d(crank.x)/d(a), by a parameter of the sensitivity; else nothing.
std::optional<std::string> differentiated(const AnalysisTask& task, std::string_view name,
                                          const ParameterNames& parameters);

/// Whether the rows of the analysis have a column of this name by themselves.
bool has_by_itself(const AnalysisTask& task, std::string_view name, const ParameterNames& parameters);

}  // namespace catena
