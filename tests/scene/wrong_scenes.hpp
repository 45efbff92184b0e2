// Scenes with a mistake: the message, the place and the exit code that belong to it. § marks the character at which the
// error must stand.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "scene/run_text.hpp"

namespace catena::testing::wrong_scenes {

struct BadScene {
  const char* what;
  std::string text;     // with the mark
  const char* message;  // a part of the message that belongs to the mark
  std::size_t errors = 1;
};

inline void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.text; }
inline const auto name_of = [](const auto& info) { return std::string(info.param.what); };

// Two bodies to hang elements on; the argument is what else the scene has.
inline std::string two_bodies(const std::string& rest) {
  return R"({"catena": 1,
  "parameters": {"l": "120 mm", "n": 3},
  "bodies": {"crank": {"points": {"tip": [0.1, 0]}}, "rod": {"position": [0.4, 0]}},
  )" + rest +
         "\n}\n";
}
inline std::string constraint(const std::string& element) { return two_bodies("\"constraints\": [" + element + "]"); }
inline std::string force(const std::string& element) { return two_bodies("\"forces\": [" + element + "]"); }
inline std::string analysis(const std::string& object) { return two_bodies("\"analyses\": [" + object + "]"); }

inline void expect_report_of(const BadScene& bad) {
  const MarkedText marked = take_mark(bad.text);
  const TextRun run = run_text(marked.text);
  const SceneOutcome& outcome = run.outcome;
  EXPECT_EQ(outcome.exit_code, 3) << outcome.error_text;
  EXPECT_EQ(run.sink.runs, 0);
  EXPECT_EQ(outcome.errors.size(), bad.errors) << outcome.error_text;
  bool found = false;
  for (const Diagnostic& error : outcome.errors) {
    if (error.message.find(bad.message) == std::string::npos) continue;
    found = true;
    EXPECT_EQ(error.line, marked.line) << outcome.error_text;
    EXPECT_EQ(error.column, marked.column) << outcome.error_text;
  }
  EXPECT_TRUE(found) << "expected: " << bad.message << "\ngot:\n" << outcome.error_text;
}

}  // namespace catena::testing::wrong_scenes
