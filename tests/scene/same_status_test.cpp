// The same trouble has the same status in every analysis that comes upon it: the table of apps/manual/statuses.md.
#include <gtest/gtest.h>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// Kinematics, dynamics and, with a pendulum that nothing drives beside it, the motion of least velocities.
const std::vector<std::string> moving{R"({"type": "kinematics", "until": 1, "every": 0.1})",
                                      R"({"type": "inverse_dynamics", "until": 1, "every": 0.1})",
                                      R"({"type": "dynamics", "until": 1, "every": 0.1})"};
const std::string free_motion = R"({"type": "kinematics", "free": "minimum_norm", "until": 1, "every": 0.1})";

/// A slider-crank of 1 m and 2 m stretched out along x, its slider driven; with a pendulum on it, or none.
std::string stretched(const std::string& drivers, const std::string& analysis, bool pendulum = false) {
  return R"({"catena": 1, "bodies": {
      "crank": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}},
      "rod": {"mass": 1, "rod": {"from": [1, 0], "to": [3, 0]}},)" +
         std::string(pendulum ? R"("bob": {"mass": 1, "rod": {"from": [3, 0], "to": [3, -1]}},)" : "") +
         R"("slider": {"mass": 1, "inertia": 0.1, "position": [3, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
      {"type": "revolute", "i": "crank.to", "j": "rod.from"}, {"type": "revolute", "i": "rod.to", "j": "slider"},)" +
         std::string(pendulum ? R"({"type": "revolute", "i": "slider", "j": "bob.from"},)" : "") +
         R"({"type": "translational", "i": "ground", "j": "slider", "axis_i": [1, 0]}],
    "drivers": [)" +
         drivers + R"(], "outputs": ["crank.angle", "crank.omega"], "analyses": [)" + analysis + "]}";
}
std::string slider(const std::string& law, const std::string& name = "drive") {
  return R"({"type": "absolute_x", "name": ")" + name + R"(", "i": "slider", "value": )" + law + "}";
}

void expect_everywhere(Status expected, const std::string& drivers, bool with_free_motion = true) {
  for (const std::string& analysis : moving) {
    const TextRun run = run_text(stretched(drivers, analysis));
    EXPECT_EQ(run.analysis().report.status, expected) << analysis << ": " << run.analysis().report.message;
  }
  if (!with_free_motion) return;
  const TextRun run = run_text(stretched(drivers, free_motion, true));
  EXPECT_EQ(run.analysis().report.status, expected) << "least velocities: " << run.analysis().report.message;
}

TEST(SameStatus, AStartFromWhichNoVelocityGoesOnIsLockedUp) {
  // At once with a velocity, outwards or inwards; or with an acceleration outwards.
  for (const char* law : {"[3, 0.1]", "[3, -0.1]", "[3, 0, 0.5]"}) {
    expect_everywhere(Status::lock_up, slider(R"({"polynomial": )" + std::string(law) + "}"));
  }
}

TEST(SameStatus, AStartThatLeavesOnTwoBranchesIsABifurcation) {
  expect_everywhere(Status::bifurcation, slider(R"({"polynomial": [3, 0, -0.5]})"));
}

TEST(SameStatus, AStartInADeadPointWhereDriversRestIsSingular) {
  expect_everywhere(Status::singular, slider("3"), false);
}

TEST(SameStatus, DriversThatContradictEachOtherAreInconsistent) {
  const std::string both =
      slider(R"({"polynomial": [2.5, 0.1]})") + ", " + slider(R"({"polynomial": [2.5, 0.2]})", "other");
  expect_everywhere(Status::inconsistent, both);
  // In the dead point as well, where they contradict what the mechanism can do besides.
  const std::string there =
      slider(R"({"polynomial": [3, 0.1]})") + ", " + slider(R"({"polynomial": [3, 0.2]})", "other");
  expect_everywhere(Status::inconsistent, there);
}

TEST(SameStatus, VelocitiesChooseTheBranchInDynamics) {
  // One of the two ways: omega^2 = 2 x'' / x_phiphi, x_phiphi = -(a + a^2 / b) = -1.5.
  for (const double side : {1.0, -1.0}) {
    std::string text = stretched(slider(R"({"polynomial": [3, 0, -0.5]})"), moving.back());
    text.replace(text.find("\"mass\": 1,"), 10, "\"mass\": 1, \"angular_velocity\": " + std::to_string(side) + ",");
    const TextRun run = run_text(text);
    ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
    EXPECT_NEAR(run.first("crank.omega"), side * std::sqrt(1 / 1.5), 1e-9);
    const std::vector<double> t = run.column("t"), angle = run.column("crank.angle");
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double across = std::sin(angle[k]);
      EXPECT_NEAR(std::cos(angle[k]) + std::sqrt(4 - across * across), 3 - 0.5 * t[k] * t[k], 1e-9);
      EXPECT_GE(side * angle[k], -1e-9);
    }
  }
}

/// Three cranks side by side on a bar, flat: one more than needed, and singular there.
std::string three_cranks(const std::string& law, const std::string& analysis) {
  std::string bodies = R"("bar": {"mass": 2, "inertia": 1, "position": [3, 0]})", joints;
  for (int k = 0; k < 3; ++k) {
    const std::string n = std::to_string(k), x = std::to_string(2 * k), end = std::to_string(2 * k + 1);
    bodies += R"(, "c)" + n + R"(": {"mass": 1, "rod": {"from": [)" + x + R"(, 0], "to": [)" + end + R"(, 0]}})";
    joints += std::string(k ? ", " : "") + R"({"type": "revolute", "i": ["ground", [)" + x + R"(, 0]], "j": "c)" + n +
              R"(.from"}, {"type": "revolute", "i": "c)" + n + R"(.to", "j": ["bar", [)" + std::to_string(2 * k - 2) +
              ", 0]]}";
  }
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + bodies + R"(}, "constraints": [)" + joints +
         R"(], "drivers": [{"type": "absolute_angle", "name": "drive", "i": "c0", "value": )" + law +
         R"(}], "outputs": ["c2.angle", "bar.y", "energy.balance"], "analyses": [)" + analysis + "]}";
}

TEST(SameStatus, RedundantMechanismsStartInTheirFlatPosition) {
  for (const std::string& analysis : moving) {
    // On the move, and from rest: with the third crank there is one way on.
    for (const char* law : {"[0, 1]", "[0, 0, 1]"}) {
      const TextRun run = run_text(three_cranks(R"({"polynomial": )" + std::string(law) + "}", analysis));
      ASSERT_EQ(run.analysis().report.status, Status::ok) << law << analysis << run.analysis().report.message;
      const std::vector<double> t = run.column("t"), angle = run.column("c2.angle"), y = run.column("bar.y");
      ASSERT_EQ(t.size(), 11u);
      for (std::size_t k = 0; k < t.size(); ++k) {
        const double driven = law[4] == '1' ? t[k] : t[k] * t[k];
        EXPECT_NEAR(angle[k], driven, 1e-8) << law << analysis;
        EXPECT_NEAR(y[k], std::sin(driven), 1e-8) << law << analysis;
      }
    }
    EXPECT_EQ(run_text(three_cranks("0", analysis)).analysis().report.status, Status::singular) << analysis;
  }
}

/// A weight on a spring that is stiffer the larger k is; P pulls.
std::string loaded(const std::string& analysis) {
  return R"({"catena": 1, "parameters": {"k": {"value": 10, "min": 1, "max": 20}, "P": {"value": 1, "max": 5}},
    "bodies": {"b": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "absolute_y", "i": "b", "value": 0}, {"type": "absolute_angle", "i": "b", "value": 0}],
    "forces": [{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "b", "k": "k", "length": 1},
               {"type": "point_force", "i": "b", "force": ["P", 0]}],
    "outputs": ["b.x"], "analyses": [)" +
         analysis + "]}";
}

TEST(SameStatus, StepsThatRunOutBeforeTheEndAreNotConverged) {
  for (const char* analysis : {R"({"type": "path", "parameter": "P", "to": 5, "arc": 0.01, "max_steps": 3})",
                               R"({"type": "dynamics", "until": 100, "max_steps": 3})"}) {
    const TextRun run = run_text(loaded(analysis));
    EXPECT_EQ(run.analysis().report.status, Status::not_converged) << analysis;
    EXPECT_GT(run.analysis().rows, 0) << analysis;
    EXPECT_EQ(run.outcome.exit_code, 1);
  }
}

TEST(SameStatus, ValuesThatAParameterMayNotHaveAreRefused) {
  const TextRun path = run_text(loaded(R"({"type": "path", "parameter": "P", "to": 6})"));
  EXPECT_EQ(path.analysis().report.status, Status::refused) << path.analysis().report.message;
  EXPECT_NEAR(path.last("P"), 5, 1e-6);
  EXPECT_NE(path.analysis().report.message.find("does not allow"), std::string::npos);
}

TEST(SameStatus, ColumnsAtTheirBucklingLoadAskForABranch) {
  // Two rods of 1 m pressed together, a spring of 1 N m/rad between them: P sin(theta) = 2 theta, one path beside the
  // straight one from P = 2 on.
  const auto column = [](const std::string& analysis) {
    return R"({"catena": 1, "parameters": {"P": 2}, "bodies": {
        "a": {"rod": {"from": [0, 0], "to": [1, 0]}}, "b": {"rod": {"from": [1, 0], "to": [2, 0]}}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"}, {"type": "revolute", "i": "a.to", "j": "b.from"},
        {"type": "absolute_y", "i": "b.to", "value": 0}],
      "forces": [{"type": "torsion_spring", "i": "a", "j": "b", "k": 1},
                 {"type": "point_force", "i": "b.to", "force": ["=-P", 0]}],
      "outputs": ["a.angle"], "analyses": [)" +
           analysis + "]}";
  };
  const std::string path = R"({"type": "path", "parameter": "P", "to": 2.5)";
  EXPECT_EQ(run_text(column(path + "}")).analysis().report.status, Status::bifurcation);
  for (const char* branch : {"1", "2", "3"}) {
    const TextRun run = run_text(column(path + R"(, "branch": )" + branch + "}"));
    ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
    const double theta = run.last("a.angle");
    EXPECT_NEAR(2.5 * std::sin(theta), 2 * theta, 1e-9);
    EXPECT_EQ(theta == 0, *branch == '1') << theta;
  }
}

// A slider-crank whose pin A is repeated by A2: what presses A alone, and rubs in it, nothing determines.
TEST(SameStatus, FrictionOfAJointThatAnotherRepeats) {
  const auto run_with = [](const std::string& more, const std::string& analysis) {
    return run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
        "c": {"mass": 1, "rod": {"from": [0, 0], "to": [0.1, 0]}},
        "r": {"mass": 1, "rod": {"from": [0.1, 0], "to": [0.4, 0]}},
        "p": {"mass": 1, "inertia": 0.01, "position": [0.4, 0]}},
      "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "c.from"},
        {"type": "revolute", "name": "A", "i": "c.to", "j": "r.from"},
        {"type": "revolute", "name": "B", "i": "r.to", "j": "p"})" +
                    more + R"(,
        {"type": "translational", "i": "ground", "j": "p", "axis_i": [1, 0], "axis_j": [1, 0]}],
      "drivers": [{"type": "absolute_angle", "name": "d", "i": "c", "value": {"polynomial": [0, 3]}}],
      "forces": [{"type": "friction", "name": "f", "joint": "A", "mu": 0.2, "radius": 0.01}],
      "outputs": ["d.load"], "analyses": [)" +
                    analysis + "]}");
  };
  for (const std::string type : {"inverse_dynamics", "dynamics"}) {
    const std::string analysis = R"({"type": ")" + type + R"(", "until": 1, "every": 0.5})";
    EXPECT_EQ(run_with("", analysis).analysis().report.status, Status::ok);
    const TextRun run = run_with(R"(, {"type": "revolute", "name": "A2", "i": "c.to", "j": "r.from"})", analysis);
    EXPECT_EQ(run.analysis().report.status, Status::refused) << type << run.analysis().report.message;
    EXPECT_NE(run.analysis().report.message.find("\"A\""), std::string::npos) << run.analysis().report.message;
  }
}

// A crank and the slider that it moves are both driven.
TEST(SameStatus, ContradictingDriversAreNamed) {
  for (const std::string analysis : {"dynamics", "kinematics"}) {
    const TextRun run = run_text(R"({"catena": 1,
      "bodies": {"c": {"mass": 1, "rod": {"from": [0, 0], "to": [0.1, 0]}},
                 "r": {"mass": 1, "rod": {"from": [0.1, 0], "to": [0.4, 0]}},
                 "p": {"mass": 1, "inertia": 0.01, "position": [0.4, 0]}},
      "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "c.from"},
        {"type": "revolute", "name": "A", "i": "c.to", "j": "r.from"},
        {"type": "revolute", "name": "B", "i": "r.to", "j": "p"},
        {"type": "translational", "name": "G", "i": "ground", "j": "p", "axis_i": [1, 0], "axis_j": [1, 0]}],
      "drivers": [{"type": "absolute_angle", "name": "d", "i": "c", "value": {"polynomial": [0, 3]}},
                  {"type": "absolute_x", "name": "d2", "i": "p", "value": {"polynomial": [0.4, 0.1]}}],
      "analyses": [{"type": ")" + analysis +
                                 R"(", "until": 1, "every": 0.1}]})");
    EXPECT_EQ(run.analysis().report.status, Status::inconsistent) << analysis;
    EXPECT_NE(run.analysis().report.message.find("\"d2\""), std::string::npos) << run.analysis().report.message;
    EXPECT_NE(run.analysis().report.message.find(" m/s"), std::string::npos) << run.analysis().report.message;
  }
}

}  // namespace
}  // namespace catena::testing
