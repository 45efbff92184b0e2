// A scene that is to run without trouble.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "scene/run_text.hpp"

namespace catena::testing {

inline TextRun good_run(const std::string& text) {
  TextRun run = run_text(text);
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text
                                      << (run.outcome.analyses.empty() ? "" : run.analysis().report.message) << text;
  return run;
}

}  // namespace catena::testing
