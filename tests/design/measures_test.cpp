// Measures against closed forms of simple motions: between the rows, not at them.
#include <gtest/gtest.h>

#include <numbers>

#include "design/measured.hpp"

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

// Rows closer together than the motion asks for are not looked between one by one; what they alone show is not missed:
// pulses as wide as a few rows, after hundreds of rows without a change.
TEST(Measures, OfDenseRowsMissNoNarrowPulse) {
  struct Pulse {
    std::string of;
    double area, exact;
  };
  const std::string u = "((crank.angle - 2.30037)/0.004)";
  for (const Pulse& pulse : {Pulse{"=exp(-" + u + "^2)", 0.004 * std::sqrt(pi), 1e-12},
                             Pulse{"=max(0, 1 - " + u + "^2)", 0.004 * 4 / 3, 1e-10}}) {
    SCOPED_TRACE(pulse.of);
    const TextRun run = run_text(crank(R"--({"area": {"integral": ")--" + pulse.of + R"--("}, "top": {"max": ")--" +
                                           pulse.of + R"--("}, "arc": {"integral": "crank.to.x"}})--",
                                       0.002));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(value(run, "top"), 1, 1e-12);
    EXPECT_NEAR(*measure(run, "top").t, 2.00037, 1e-10);
    EXPECT_NEAR(value(run, "area"), pulse.area, pulse.exact);
    EXPECT_NEAR(value(run, "arc"), std::sin(5.3) - std::sin(0.3), 1e-12);
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

// The motion starts at 0, whatever the rows, and every part of it counts once.
TEST(Measures, ListedRowsMayStartLateAndBeInAnyOrder) {
  for (const std::string at : {"[1, 2.5]", "[2.5, 1]", "[1, 0.2, 2.5]", "[0, 2.5, 1, 2]"}) {
    SCOPED_TRACE(at);
    std::string text = crank(R"({"area": {"integral": "crank.to.x"}, "mean": {"mean": "crank.to.x"},
      "most": {"max": "crank.to.y"}, "final": {"final": "crank.to.y"}})");
    const std::string times = R"("until": 5, "every": 5.000000)";
    text.replace(text.find(times), times.size(), R"("at": )" + at);
    const TextRun run = run_text(text);
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(value(run, "area"), std::sin(2.8) - std::sin(0.3), 1e-12);
    EXPECT_NEAR(value(run, "mean"), (std::sin(2.8) - std::sin(0.3)) / 2.5, 1e-12);
    EXPECT_NEAR(value(run, "most"), 1, 1e-14);
    EXPECT_NEAR(value(run, "final"), std::sin(2.8), 1e-14);
  }
}

TEST(Measures, OfWhatIsNoNumberHaveNoValue) {
  const TextRun run =
      run_text(crank(R"--({"end": {"final": "=sqrt(crank.to.y)"}, "area": {"integral": "=sqrt(crank.to.y)"},
    "most": {"max": "=sqrt(crank.to.y)"}, "size": {"rms": "=sqrt(crank.to.y)"}})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_FALSE(measure(run, "size").value);
  EXPECT_NE(measure(run, "size").trouble.find("not a number everywhere"), std::string::npos)
      << measure(run, "size").trouble;
  EXPECT_FALSE(measure(run, "end").value);
  EXPECT_NE(measure(run, "end").trouble.find("not a number at t = 5"), std::string::npos)
      << measure(run, "end").trouble;
  EXPECT_FALSE(measure(run, "area").value);
  EXPECT_NEAR(value(run, "most"), 1, 1e-12);
  EXPECT_FALSE(measure(run, "most").trouble.empty());
}

TEST(Measures, OfAMotionOfLeastVelocitiesHaveNoIntegral) {
  const TextRun run = run_text(R"({"catena": 1,
  "bodies": {"a": {"rod": {"from": [0, 0], "to": [1, 0]}}, "b": {"rod": {"from": [1, 0], "to": [2, 0]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"}],
  "drivers": [{"type": "absolute_angle", "i": "a", "value": {"polynomial": [0, 1]}}],
  "outputs": ["b.angle"],
  "analyses": [{"type": "kinematics", "free": "minimum_norm", "until": 1, "every": 0.1, "measures": {
    "area": {"integral": "a.angle"}, "most": {"max": "a.angle"}, "at": {"at": 0.55, "of": "a.angle"}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_FALSE(measure(run, "area").value);
  EXPECT_NE(measure(run, "area").trouble.find("between its rows"), std::string::npos);
  EXPECT_NEAR(value(run, "most"), 1, 1e-9);
  EXPECT_FALSE(measure(run, "at").value);
  EXPECT_NE(measure(run, "at").trouble.find("none of its rows"), std::string::npos);
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

// Under gravity of 10 m/s^2 against a damper of 0.5 N m s: W = 5 (sin(0.3 + t) - sin 0.3) + 0.5 t, 0.5 t of it
// dissipated.
TEST(Measures, OfWorkBetweenTheRows) {
  std::string text = crank(
      R"--({"most": {"max": "drive.work"}, "lost": {"integral": "energy.dissipated"}, "given": {"integral": "drive.power"},
    "end": {"final": "drive.work"}, "doubt": {"max": "=abs(energy.balance)"}})--",
      5, "inverse_dynamics");
  text.insert(text.find("\"bodies\""), R"("gravity": [0, -10],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "crank", "k": 0, "c": 0.5}], )");
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double top = std::acos(-0.1) - 0.3;
  const auto work = [](double t) { return 5 * (std::sin(0.3 + t) - std::sin(0.3)) + 0.5 * t; };
  EXPECT_NEAR(value(run, "most"), work(top), 1e-9);
  EXPECT_NEAR(*measure(run, "most").t, top, 1e-7);
  EXPECT_NEAR(value(run, "lost"), 0.25 * 25, 1e-9);
  EXPECT_NEAR(value(run, "given"), work(5), 1e-9);
  EXPECT_EQ(measure(run, "given").unit, "J");
  EXPECT_NEAR(value(run, "end"), work(5), 1e-9);
  EXPECT_LT(value(run, "doubt"), 1e-9);
  EXPECT_TRUE(measure(run, "most").trouble.empty()) << measure(run, "most").trouble;
}

TEST(Measures, OfWhatAnAnalysisReports) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 3}},
  "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],
  "analyses": [{"type": "equilibrium", "measures": {"energy": {"field": "energy"}, "none": {"field": "lode[1]"}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(value(run, "energy"), -15, 1e-9);
  EXPECT_FALSE(measure(run, "none").value);
  EXPECT_NE(measure(run, "none").trouble.find("reports no number lode"), std::string::npos);
}

// A rod of 2 m, put on its driver at 0.3 rad.
TEST(Measures, OfACheckAreThoseOfTheAssembledPlace) {
  const TextRun run = run_text(R"({"catena": 1,
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": [2, 0.1]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "rod.from"}],
  "drivers": [{"type": "absolute_angle", "i": "rod", "value": 0.3}],
  "analyses": [{"type": "check", "measures": {"height": {"first": "rod.to.y"}, "freedoms": {"field": "mobility"}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(value(run, "height"), std::hypot(2, 0.1) * std::sin(0.3), 1e-12);
  EXPECT_EQ(value(run, "freedoms"), 1);
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
  expect_error(R"({"a": {"max": "crank.x", "min": §"crank.x"}})", "a measure is of one kind");
  expect_error(R"({"a": {"max": §"crank.q"}})", "crank.q");
  expect_error(R"({"a": {"max": §"crank"}})", "a measure wants one column");
  expect_error(R"({§"a b": {"max": "crank.x"}})", "cannot stand in an expression");
  expect_error(R"({"a": {"field": §"omega[0]"}})", "count from 1");
  const MarkedText shapes = take_mark(R"({"catena": 1, "bodies": {"a": {"mass": 1, "particle": true}},
  "analyses": [{"type": "modes", "measures": {"a": {"max": §"a.x"}}}]})");
  const TextRun modes = run_text(shapes.text);
  ASSERT_FALSE(modes.outcome.errors.empty());
  EXPECT_EQ(modes.outcome.errors.front().column, shapes.column);
  EXPECT_NE(modes.outcome.errors.front().message.find("omega2[1]"), std::string::npos);
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
