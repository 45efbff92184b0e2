// Columns of a scene's own, and what is said of wrong ones.
#include <gtest/gtest.h>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A crank of length r that turns w rad/s, its angle w t; columns and outputs as given.
std::string crank(const std::string& columns, const std::string& outputs, const std::string& more = "") {
  return R"({"catena": 1, "parameters": {"r": 0.3, "w": 2},
  "columns": )" +
         columns + R"(,
  "bodies": {"crank": {"rod": {"from": [0, 0], "to": ["r", 0]}}, "long rod": {"position": [1, 2], "fixed": true}},
  "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "crank.from"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "w"]}}],
  "outputs": )" +
         outputs + R"(,
  "analyses": [{"type": "kinematics", "until": 1, "every": 0.25)" +
         more + "}]}";
}

TEST(OwnColumns, AreFormulasOverColumnsParametersAndTime) {
  const TextRun run = run_text(crank(
      R"--({"speed": {"value": "=sqrt(crank.to.vx^2 + crank.to.vy^2)", "unit": "m/s"},
          "twice": "=2*speed + t*r", "far": "='long rod'.x - crank.to.x"})--",
      R"(["speed", "twice", "far", "=crank.angle - w*t"])"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> t = run.column("t"), speed = run.column("speed"), twice = run.column("twice"),
                            far = run.column("far"), angle = run.column("=crank.angle - w*t");
  ASSERT_EQ(t.size(), 5u);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(speed[k], 0.6, 1e-14);
    EXPECT_NEAR(twice[k], 1.2 + 0.3 * t[k], 1e-14);
    EXPECT_NEAR(far[k], 1 - 0.3 * std::cos(2 * t[k]), 1e-14);
    EXPECT_NEAR(angle[k], 0, 1e-14);
  }
  EXPECT_EQ(run.sink.rows.at(0).columns()[1].unit_text(), "m/s");
}

TEST(OwnColumns, AreWatchedByEvents) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
  "columns": {"height": "=ball.y - 1"},
  "bodies": {"ball": {"mass": 2, "particle": true, "position": [0, 6]}}, "outputs": ["height"],
  "analyses": [{"type": "dynamics", "until": 3, "every": 1,
                "events": [{"name": "there", "when": "height", "action": "stop"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("t"), 1, 1e-9);  // 5 m by 10 m/s^2
}

void expect_error(const std::string& marked, const std::string& part) {
  const MarkedText mark = take_mark(marked);
  const TextRun run = run_text(mark.text);
  EXPECT_EQ(run.outcome.exit_code, 3);
  ASSERT_FALSE(run.outcome.errors.empty()) << marked;
  const Diagnostic& error = run.outcome.errors.front();
  EXPECT_EQ(error.line, mark.line) << error.message;
  EXPECT_EQ(error.column, mark.column) << error.message;
  EXPECT_NE(error.message.find(part), std::string::npos) << error.message;
}

TEST(OwnColumns, WrongOnesAreReportedWhereTheyStand) {
  expect_error(crank(R"({"a": "=§crnk.x + 1"})", R"(["a"])"), "crnk");
  expect_error(crank(R"({"a": "=1 + §R"})", R"(["a"])"), "there is no column or parameter \"R\"; did you mean \"r\"?");
  expect_error(crank(R"({"a": §"=b", "b": "=a + 1"})", R"(["a"])"), "in a circle: a -> b -> a");
  expect_error(crank(R"--({"a": "=sqrt(§crank)"})--", R"(["a"])"), "stands for");
  expect_error(crank(R"({§"r": "=t"})", R"(["r"])"), "a parameter is called \"r\" already");
  expect_error(crank(R"({"a": {"value": "=t", "unit": §"mm"}})", R"(["a"])"), "its unit is \"m\"");
  expect_error(crank(R"({"a": §"t"})", R"(["a"])"), "begins with =");
  expect_error(crank(R"({"a": "=t"})", R"(["=2*§crank.z"])"), "crank.z");
}

TEST(OwnColumns, WhatAnAnalysisCannotGiveIsLeftOutWithANote) {
  std::string text = crank(R"({"load": "=2*drive.load"})", R"(["load", "crank.x"])");
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(run.column("load").empty());
  ASSERT_FALSE(run.analysis().report.warnings.empty());
  EXPECT_NE(run.analysis().report.warnings.front().find("left out load"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
