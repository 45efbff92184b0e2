// Fields and warnings of a result, by name.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scene/run_text.hpp"

namespace catena::testing {

inline bool warns(const AnalysisResult& result, const std::string& part) {
  return std::any_of(result.report.warnings.begin(), result.report.warnings.end(),
                     [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
}

template <class T>
T field_of(const AnalysisResult& result, const std::string& name) {
  for (const NamedField& f : result.fields) {
    if (f.name == name) return std::get<T>(f.value);
  }
  ADD_FAILURE() << "no field " << name << "; " << result.report.message;
  return {};
}

template <class T>
T value_of(const FieldRecord& record, const std::string& name) {
  for (const auto& [key, value] : record) {
    if (key == name) return std::get<T>(value);
  }
  ADD_FAILURE() << "no value " << name;
  return {};
}

#define ASSERT_FINE(run) \
  ASSERT_EQ((run).outcome.exit_code, 0) << (run).outcome.error_text << (run).outcome.analyses.back().report.message

}  // namespace catena::testing
