// A named result of an analysis as JSON, the same in result documents and in the data of pages.
#pragma once

#include <string>

#include "catena/results/analysis_result.hpp"

namespace catena {

/// Appends the value: a number, text, list or list of objects.
void append_field(std::string& out, const FieldValue& value);

}  // namespace catena
