// Running the analyses of a scene: order, state, time, parameters, outcomes.
#include <gtest/gtest.h>

#include <atomic>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// A crank turning at `speed`; the argument is the list of analyses.
std::string crank(const std::string& analyses, const std::string& more = "") {
  return R"({"catena": 1, "name": "one crank", "gravity": [0, -10], "parameters": {"speed": 2},
    "bodies": {"crank": {"mass": 3, "rod": {"from": [0, 0], "to": [0.5, 0]}}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "crank.from"}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "speed"]}}],)" +
         more + R"("analyses": [)" + analyses + R"(], "outputs": ["crank.angle"]})";
}

TEST(SceneRunner, AnalysesGoOnFromWhereTheOneBeforeEnded) {
  const TextRun run = run_text(crank(R"({"type": "kinematics", "until": 1, "every": 0.5},
    {"type": "kinematics", "until": 1.75, "every": 0.5}, {"type": "kinematics"},
    {"type": "kinematics", "from": "initial", "at": [0, 3]})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.column("t", 0), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(run.column("t", 1), (std::vector<double>{1, 1.5, 1.75}));
  EXPECT_EQ(run.column("t", 2), (std::vector<double>{1.75}));
  EXPECT_EQ(run.column("t", 3), (std::vector<double>{0, 3}));
  EXPECT_NEAR(run.last("crank.angle", 2), 3.5, 1e-12);
  EXPECT_NEAR(run.last("crank.angle", 3), 6, 1e-12);
  EXPECT_TRUE(run.sink.ended);
}

TEST(SceneRunner, RowsAreAMultipleNotASum) {
  const TextRun run = run_text(crank(R"({"type": "kinematics", "until": 100, "every": 0.1})"));
  const std::vector<double> t = run.column("t");
  ASSERT_EQ(t.size(), 1001u);
  for (std::size_t k = 0; k < t.size(); ++k) EXPECT_EQ(t[k], k == 1000 ? 100 : static_cast<double>(k) * 0.1);
}

TEST(SceneRunner, ParametersChangeForOneAnalysis) {
  const TextRun run = run_text(crank(R"({"type": "kinematics", "at": 1, "set": {"speed": 5}},
    {"type": "kinematics", "from": "initial", "at": 1})"));
  EXPECT_NEAR(run.last("crank.angle", 0), 5, 1e-12);
  EXPECT_NEAR(run.last("crank.angle", 1), 2, 1e-12);
  RunOptions options;
  options.set = {{"speed", "=3*2"}};
  EXPECT_NEAR(run_text(crank(R"({"type": "kinematics", "at": 1})"), options).last("crank.angle"), 6, 1e-12);
}

TEST(SceneRunner, AVerbTakesThePlaceOfTheList) {
  RunOptions options;
  options.verb = "inverse_dynamics";
  options.verb_options = {{"at", "0"}, {"at", "+0.5"}, {"outputs", "drive.load"}, {"outputs", "O.fy"}};
  const TextRun run = run_text(crank(R"({"type": "check"})"), options);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  ASSERT_EQ(run.outcome.analyses.size(), 1u);
  // Weight 30 N on an arm of 0.25 m.
  EXPECT_NEAR(run.first("drive.load"), 7.5, 1e-12);
  EXPECT_NEAR(run.last("drive.load"), 7.5 * std::cos(1.0), 1e-12);
  EXPECT_NEAR(run.first("O.fy"), 30, 1e-12);
}

TEST(SceneRunner, OutputsOfASensitivityOfNothingAreAnError) {
  RunOptions options;
  options.outputs = {"crank.angle"};
  const TextRun run = run_text(crank(R"({"type": "sensitivity"})"), options);
  EXPECT_EQ(run.outcome.exit_code, 3);
  EXPECT_NE(run.outcome.error_text.find("\"of\""), std::string::npos) << run.outcome.error_text;
}

TEST(SceneRunner, AFailureEndsTheRunUnlessTheNextStartsAnew) {
  const std::string early = R"({"type": "kinematics", "at": 2}, {"type": "kinematics", "until": 1})";
  TextRun run = run_text(crank(early + R"(, {"type": "kinematics", "at": 1})"));
  EXPECT_EQ(run.outcome.exit_code, 1);
  ASSERT_EQ(run.outcome.analyses.size(), 2u);
  EXPECT_EQ(run.analysis(1).report.status, Status::refused);
  EXPECT_NE(run.analysis(1).report.message.find("starts at 2 s"), std::string::npos);
  run = run_text(crank(early + R"(, {"type": "kinematics", "from": "initial", "at": 1})"));
  EXPECT_EQ(run.outcome.exit_code, 1);
  ASSERT_EQ(run.outcome.analyses.size(), 3u);
  EXPECT_TRUE(run.analysis(2).report.ok());
}

TEST(SceneRunner, DynamicsFollowsFromForces) {
  // A rod falling freely from rest beside the crank: y = -g t^2 / 2, energy kept.
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
    "bodies": {"rod": {"mass": 3, "rod": {"from": [0, 0], "to": [0.5, 0]}, "velocity": [1, 0], "angular_velocity": 2}},
    "analyses": [{"type": "dynamics", "until": 1, "every": 0.25, "tolerance": 1e-10}],
    "outputs": ["rod", "energy.balance"]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("rod.y"), -5, 1e-9);
  EXPECT_NEAR(run.last("rod.x"), 1.25, 1e-9);
  EXPECT_NEAR(run.last("rod.angle"), 2, 1e-9);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
}

TEST(SceneRunner, CheckCountsAndNamesWhatIsRedundant) {
  const TextRun run =
      run_text(R"({"catena": 1, "bodies": {"a": {}, "b": {"position": [1, 0]}, "free": {"position": [5, 0]}},
    "constraints": [{"type": "weld", "name": "W", "i": "ground", "j": "a"}, {"type": "revolute", "name": "P", "i": "a", "j": "b", "at": [1, 0]},
                    {"type": "absolute_x", "name": "again", "i": "a", "value": 0}],
    "analyses": [{"type": "check"}]})");
  const AnalysisReport& report = run.analysis().report;
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.bodies, 3);
  EXPECT_EQ(report.rows, 6);
  EXPECT_EQ(report.rank, 5);
  EXPECT_EQ(report.dof, 4);
  EXPECT_EQ(report.redundant.size(), 1u);
}

TEST(SceneRunner, TablesThatAreTooShortAreRefused) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {}},
    "constraints": [{"type": "absolute_x", "i": "a"}, {"type": "absolute_y", "i": "a"}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "a", "value": {"spline": {"t": [0, 1, 2], "value": [0, 1, 0]}}}],
    "analyses": [{"type": "kinematics", "until": 3, "every": 1}]})");
  EXPECT_EQ(run.analysis().report.status, Status::refused);
  EXPECT_NE(run.analysis().report.message.find("\"drive\""), std::string::npos) << run.analysis().report.message;
}

TEST(SceneRunner, ProgressIsToldAndARunCanBeCancelled) {
  std::atomic<bool> cancel = false;
  RunOptions options;
  options.cancel = &cancel;
  double last = 0;
  options.progress = [&](const Progress& progress) {
    EXPECT_GE(progress.fraction, last);
    last = progress.fraction;
    if (progress.fraction > 0.3) cancel = true;
  };
  const TextRun run =
      run_text(crank(R"({"type": "kinematics", "until": 10, "every": 0.1}, {"type": "kinematics", "from": "initial"})"),
               options);
  EXPECT_EQ(run.outcome.exit_code, 1);
  ASSERT_EQ(run.outcome.analyses.size(), 1u);
  EXPECT_EQ(run.analysis().report.status, Status::cancelled);
  EXPECT_GT(run.analysis().rows, 25);
  EXPECT_LT(run.analysis().rows, 40);
  EXPECT_TRUE(run.sink.ended);
}

TEST(SceneRunner, ARunIsCancelledBetweenRows) {
  for (const std::string type : {"kinematics", "inverse_dynamics", "dynamics"}) {
    std::atomic<bool> cancel = false;
    RunOptions options;
    options.cancel = &cancel;
    options.progress = [&](const Progress& progress) { cancel = progress.fraction > 0.3; };
    const TextRun run = run_text(crank(R"({"type": ")" + type + R"(", "until": 1000, "every": 1000})"), options);
    EXPECT_EQ(run.analysis().report.status, Status::cancelled) << type;
    EXPECT_EQ(run.analysis().rows, 1) << type;
    EXPECT_EQ(run.outcome.exit_code, 1) << type;
  }
}

// check says what dynamics would make of velocities that the constraints do not allow.
TEST(SceneRunner, CheckTellsOfVelocitiesThatDoNotFit) {
  const auto pendulum = [](const std::string& velocity) {
    return R"({"catena": 1, "bodies": {"a": {"mass": 2, "position": [1, 0], "inertia": 1, "angular_velocity": 3)" +
           velocity + R"(}}, "constraints": [{"type": "revolute", "i": "ground", "j": "a", "at": [0, 0]}],
      "analyses": [{"type": "check"}]})";
  };
  const TextRun wrong = run_text(pendulum(R"(, "velocity": [1, 3])"));
  ASSERT_EQ(wrong.analysis().report.warnings.size(), 1u);
  EXPECT_NE(wrong.analysis().report.warnings[0].find("changes them by up to 1 m/s (body \"a\")"), std::string::npos)
      << wrong.analysis().report.warnings[0];
  EXPECT_TRUE(run_text(pendulum(R"(, "velocity": [0, 3])")).analysis().report.warnings.empty());
  EXPECT_TRUE(run_text(pendulum("")).analysis().report.warnings.empty());
}

}  // namespace
}  // namespace catena::testing
