// One number of data/reference/<name>.json: independent values in high precision, with their source.
#pragma once

#include <string>
#include <string_view>

namespace bench {

/// `path` leads from "values" on, as "t=0.03/q/2". Throws std::runtime_error that names the file and what is missing.
/// `folder` empty: data/reference of the sources that the program was built from.
double reference_value(const std::string& folder, const std::string& name, std::string_view path);

}  // namespace bench
