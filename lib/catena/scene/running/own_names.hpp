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

/// Why columns that the caller names cannot be given: all of these analyses have columns of their own alone, and one of
/// the names is none of them. Nothing where they can be, or where no analysis is run.
std::optional<std::string> why_no_outputs(const std::vector<AnalysisTask>& tasks, const std::vector<std::string>& names,
                                          const ParameterNames& parameters);

}  // namespace catena
