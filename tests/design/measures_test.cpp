// Measures against closed forms of simple motions: between the rows, not at them.
#include <gtest/gtest.h>

#include <numbers>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// A crank of 1 m whose angle is 0.3 + t; two rows unless `every` says otherwise.
std::string crank(const std::string& measures, double every = 5, const std::string& type = "kinematics") {
  return R"({"catena": 1,
  "bodies": {"crank": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0.3, 1]}}],
  "outputs": ["crank.to.x"],
  "analyses": [{"type": ")" +
         type + R"(", "until": 5, "every": )" + std::to_string(every) + R"(, "measures": )" + measures + "}]}";
}

const MeasureResult& measure(const TextRun& run, const std::string& name) {
  static const MeasureResult missing;
  for (const MeasureResult& m : run.analysis().measures) {
    if (m.name == name) return m;
  }
  ADD_FAILURE() << "no measure " << name << " " << run.analysis().report.message << run.outcome.error_text;
  return missing;
}
double value(const TextRun& run, const std::string& name) { return measure(run, name).value.value_or(std::nan("")); }

TEST(Measures, ExtremesLieBetweenRows) {
  const TextRun run = run_text(crank(R"--({"least": {"min": "crank.to.x"}, "most": {"max": "crank.to.y"},
    "span": {"range": "crank.to.x"}, "kink": {"min": "=abs(crank.to.x)"}, "latest": {"max": "t"}})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(value(run, "least"), -1, 1e-15);
  EXPECT_NEAR(*measure(run, "least").t, pi - 0.3, 1e-9);
  EXPECT_NEAR(value(run, "most"), 1, 1e-15);
  EXPECT_NEAR(*measure(run, "most").t, pi / 2 - 0.3, 1e-9);
  EXPECT_NEAR(value(run, "span"), 1 + std::cos(0.3), 1e-14);
  EXPECT_NEAR(value(run, "kink"), 0, 1e-8);
  EXPECT_EQ(value(run, "latest"), 5);
  EXPECT_EQ(measure(run, "least").unit, "m");
}

TEST(Measures, IntegralsAreOverTimeNotRows) {
  const std::string measures = R"({"area": {"integral": "crank.to.x"}, "square": {"integral": "=crank.to.x^2"},
    "mean": {"mean": "crank.to.y"}, "rms": {"rms": "crank.to.y"}, "first": {"first": "crank.to.y"},
    "final": {"final": "crank.to.y"}, "at": {"at": 1.234, "of": "crank.to.y"}})";
  for (const double every : {5.0, 0.7}) {
    const TextRun run = run_text(crank(measures, every));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const double area = std::sin(5.3) - std::sin(0.3), square = 2.5 + (std::sin(10.6) - std::sin(0.6)) / 4;
    EXPECT_NEAR(value(run, "area"), area, 1e-12);
    EXPECT_NEAR(value(run, "square"), square, 1e-11);
    EXPECT_NEAR(value(run, "mean"), (std::cos(0.3) - std::cos(5.3)) / 5, 1e-12);
    EXPECT_NEAR(value(run, "rms"), std::sqrt((5 - square) / 5), 1e-12);
    EXPECT_NEAR(value(run, "first"), std::sin(0.3), 1e-15);
    EXPECT_NEAR(value(run, "final"), std::sin(5.3), 1e-14);
    EXPECT_NEAR(value(run, "at"), std::sin(1.534), 1e-14);
    EXPECT_EQ(measure(run, "area").unit, "m s");
  }
}

TEST(Measures, PathsAreMeasuredFromGivenPoints) {
  const TextRun run = run_text(crank(R"({
    "near": {"path": ["crank.to.x", "crank.to.y"], "to": [[0, 1.5], [-2, 0]]},
    "timed": {"path": ["crank.to.x", "crank.to.y"], "to": [[1, 0], [0, 1], [0, 0]], "timed": true}})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(value(run, "near"), std::sqrt((0.25 + 1) / 2), 1e-12);
  const auto square = [](double angle, double x, double y) {
    return std::pow(std::cos(angle) - x, 2) + std::pow(std::sin(angle) - y, 2);
  };
  EXPECT_NEAR(value(run, "timed"), std::sqrt((square(0.3, 1, 0) + square(2.8, 0, 1) + 1) / 3), 1e-13);
}

TEST(Measures, OfMotionsUnderForces) {
  // A spring of 4 N/m and a mass of 1 kg, released at 1 m: x = cos 2t.
  const TextRun run = run_text(R"--({"catena": 1,
  "bodies": {"mass": {"mass": 1, "particle": true, "position": [1, 0]}},
  "constraints": [{"type": "absolute_y", "i": "mass", "value": 0}],
  "forces": [{"type": "spring_damper", "name": "spring", "i": "ground", "j": "mass", "k": 4, "length": 0}],
  "outputs": ["mass.x"],
  "analyses": [{"type": "dynamics", "until": 3, "every": 3, "tolerance": 1e-10, "measures": {
     "least": {"min": "mass.x"}, "fast": {"max": "=abs(mass.vx)"}, "pull": {"integral": "=mass.x^2"}}}]})--");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(value(run, "least"), -1, 1e-9);
  EXPECT_NEAR(*measure(run, "least").t, pi / 2, 1e-8);
  EXPECT_NEAR(value(run, "fast"), 2, 1e-9);
  EXPECT_NEAR(value(run, "pull"), 1.5 + std::sin(12) / 8, 1e-9);
}

TEST(Measures, OfWhatAnAnalysisReports) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 3}},
  "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],
  "analyses": [{"type": "equilibrium", "measures": {"energy": {"field": "energy"}, "none": {"field": "loads[1]"}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(value(run, "energy"), -15, 1e-9);
  EXPECT_FALSE(measure(run, "none").value);
  EXPECT_NE(measure(run, "none").trouble.find("reports no number loads"), std::string::npos);
}

TEST(Measures, WrongOnesAreReportedWhereTheyStand) {
  const auto expect_error = [](const std::string& measures, const std::string& part) {
    const MarkedText mark = take_mark(crank(measures));
    const TextRun run = run_text(mark.text);
    EXPECT_EQ(run.outcome.exit_code, 3);
    ASSERT_FALSE(run.outcome.errors.empty()) << measures;
    EXPECT_EQ(run.outcome.errors.front().line, mark.line) << run.outcome.errors.front().message;
    EXPECT_EQ(run.outcome.errors.front().column, mark.column) << run.outcome.errors.front().message;
    EXPECT_NE(run.outcome.errors.front().message.find(part), std::string::npos) << run.outcome.errors.front().message;
  };
  expect_error(R"({"a": §{"maxi": "crank.x"}})", "did you mean \"max\"?");
  expect_error(R"({"a": {"max": §"crank.q"}})", "crank.q");
  expect_error(R"({"a": {"max": §"crank"}})", "a measure wants one column");
  expect_error(R"({§"a b": {"max": "crank.x"}})", "cannot stand in an expression");
  expect_error(R"({"a": {"field": §"omega[0]"}})", "count from 1");
}

TEST(Measures, LeastAndLargestOfEveryColumnStandInTheReport) {
  const TextRun run = run_text(crank("{}", 0.1));
  ASSERT_EQ(run.analysis().extremes.size(), 1u);
  const ColumnExtreme& extreme = run.analysis().extremes.front();
  EXPECT_EQ(extreme.name, "crank.to.x");
  EXPECT_NEAR(extreme.least, std::cos(0.3 + 2.8), 1e-12);
  EXPECT_NEAR(extreme.least_t, 2.8, 1e-12);
  EXPECT_NEAR(extreme.largest, std::cos(0.3), 1e-12);
}

}  // namespace
}  // namespace catena::testing
