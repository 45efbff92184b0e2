// Columns that an analysis has whatever outputs are named: the time, the parameter of a path, the measures of a sweep.
#pragma once

#include <string_view>

#include "catena/scene/numbers/parameter_names.hpp"
#include "catena/scene/reading/analysis_task.hpp"

namespace catena {

/// Whether the rows of the analysis have a column of this name by themselves.
bool has_by_itself(const AnalysisTask& task, std::string_view name, const ParameterNames& parameters);

}  // namespace catena
