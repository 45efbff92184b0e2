// The report of a run that was made in parts: the outcome of the last one, counts and warnings of all.
#pragma once

#include <algorithm>
#include <utility>

#include "catena/analysis/run/analysis_report.hpp"

namespace catena {

/// Adds the report of the next part. A warning that was given before is not repeated.
inline void add_part(AnalysisReport& total, AnalysisReport part) {
  std::vector<std::string> warnings = std::move(total.warnings);
  for (std::string& warning : part.warnings) {
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(std::move(warning));
  }
  part.warnings = std::move(warnings);
  part.counters += total.counters;
  part.seconds += total.seconds;
  total = std::move(part);
}

}  // namespace catena
