// Measures of the first analysis of a run, with their gradients; a missing one is a failure.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scene/run_text.hpp"

namespace catena::testing {

inline const MeasureResult& measure(const TextRun& run, const std::string& name) {
  static const MeasureResult missing;
  for (const MeasureResult& m : run.analysis().measures) {
    if (m.name == name) return m;
  }
  ADD_FAILURE() << "no measure " << name << " " << run.analysis().report.message << run.outcome.error_text;
  return missing;
}

inline bool went_back(const TextRun& run) { return field<std::string>(run, "mode") == "adjoint"; }

inline double value(const TextRun& run, const std::string& name) {
  return measure(run, name).value.value_or(std::nan(""));
}

/// d(measure)/d(parameter number p).
inline double gradient(const TextRun& run, const std::string& name, std::size_t p) {
  const MeasureResult& found = measure(run, name);
  if (p < found.gradient.size()) return found.gradient[p];
  ADD_FAILURE() << "no gradient of " << name << " " << run.analysis().report.message;
  return std::nan("");
}

/// Whether a warning of the first analysis has this part.
inline bool warns(const TextRun& run, const std::string& part) {
  for (const std::string& warning : run.analysis().report.warnings) {
    if (warning.find(part) != std::string::npos) return true;
  }
  return false;
}

}  // namespace catena::testing
