// The derivatives of a measure with the names of the parameters they are by, as result sinks write them.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "catena/results/analysis_result.hpp"

namespace catena {

/// One for each of the result's gradient_parameters; NaN where the measure has none.
inline std::vector<std::pair<std::string, double>> named_gradient(const AnalysisResult& result,
                                                                  const MeasureResult& measure) {
  std::vector<std::pair<std::string, double>> named;
  for (std::size_t p = 0; p < result.gradient_parameters.size(); ++p) {
    const bool known = p < measure.gradient.size();
    named.emplace_back(result.gradient_parameters[p],
                       known ? measure.gradient[p] : std::numeric_limits<double>::quiet_NaN());
  }
  return named;
}

}  // namespace catena
