// Inverse dynamics of scenes: loads of drivers, and the least reactions where there is a choice.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

bool warns_of(const AnalysisResult& result, const std::string& part) {
  return std::any_of(result.report.warnings.begin(), result.report.warnings.end(),
                     [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
}

// Three supports share the weight of a beam: of all (L, M, L) with 2 L + M = 98.1 N the least are equal.
TEST(InverseDynamics, ABeamOnThreeSupportsHasTheLeastReactions) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"b": {"mass": 10, "inertia": 1, "points": {"l": [-1, 0], "m": [0, 0], "r": [1, 0]}}},
    "constraints": [{"type": "absolute_y", "name": "L", "i": "b.l", "value": 0},
                    {"type": "absolute_y", "name": "M", "i": "b.m", "value": 0},
                    {"type": "absolute_y", "name": "R", "i": "b.r", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "D", "i": "b.l", "value": {"polynomial": [0, 0, 0.5]}}],
    "analyses": [{"type": "inverse_dynamics", "until": 1, "every": 0.5, "outputs": ["L.fy", "M.fy", "R.fy", "D.load"]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (const char* name : {"L.fy", "M.fy", "R.fy"}) {
    for (double force : run.column(name)) EXPECT_NEAR(force, 32.7, 1e-9) << name;
  }
  // What is unique stays what it is, and is not named.
  for (double load : run.column("D.load")) EXPECT_NEAR(load, 10, 1e-9);
  EXPECT_TRUE(warns_of(run.analysis(), R"(reactions of "L", "M", "R" are not unique)"));
}

// Three parallel cranks carry a platform, one is driven: the loads of inverse dynamics are those of dynamics.
TEST(InverseDynamics, AgreesWithDynamicsWhereReactionsAreNotUnique) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"c1": {"rod": {"from": [0, 0], "to": [0, -1]}, "mass": 1, "angular_velocity": 1},
               "c2": {"rod": {"from": [1, 0], "to": [1, -1]}, "mass": 1},
               "c3": {"rod": {"from": [2, 0], "to": [2, -1]}, "mass": 1},
               "p": {"mass": 5, "inertia": 1, "position": [1, -1]}},
    "constraints": [{"type": "revolute", "name": "O1", "i": "ground", "j": "c1.from"},
                    {"type": "revolute", "name": "O2", "i": ["ground", [1, 0]], "j": "c2.from"},
                    {"type": "revolute", "name": "O3", "i": ["ground", [2, 0]], "j": "c3.from"},
                    {"type": "revolute", "name": "P1", "i": "c1.to", "j": ["p", [-1, 0]]},
                    {"type": "revolute", "name": "P2", "i": "c2.to", "j": ["p", [0, 0]]},
                    {"type": "revolute", "name": "P3", "i": "c3.to", "j": ["p", [1, 0]]}],
    "drivers": [{"type": "absolute_angle", "name": "D", "i": "c1", "value": {"polynomial": ["=-pi/2", 1]}}],
    "outputs": ["P1.fx", "P2.fx", "P3.fx", "P1.fy", "P2.fy", "P3.fy", "D.load"],
    "analyses": [{"type": "inverse_dynamics", "at": [0.1, 0.2]},
                 {"type": "dynamics", "from": "initial", "at": [0.1, 0.2], "tolerance": 1e-11}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (const char* name : {"P1.fx", "P2.fx", "P3.fx", "P1.fy", "P2.fy", "P3.fy", "D.load"}) {
    const std::vector<double> inverse = run.column(name, 0), dynamics = run.column(name, 1);
    ASSERT_EQ(inverse.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(inverse[k], dynamics[k], 1e-7) << name;
      EXPECT_GT(std::abs(inverse[k]), 0.01) << name;
    }
  }
  EXPECT_TRUE(warns_of(run.analysis(0), "are not unique"));
  EXPECT_TRUE(warns_of(run.analysis(1), "are not unique"));
}

// A slider-crank driven at varying speed against gravity, a damper and a force that changes with time: work is the
// integral of power, however far apart rows are; dynamics sums it up on its own.
TEST(InverseDynamics, SumsUpWork) {
  const auto scene = [](const std::string& rows) {
    return R"({"catena": 1, "gravity": [0, -9.81],
      "bodies": {"crank": {"mass": 2, "rod": {"from": [0, 0], "to": [0.3, 0.2]}, "angular_velocity": 3},
                 "rod": {"mass": 3, "rod": {"from": [0.3, 0.2], "to": [1.2, 0]}},
                 "slider": {"mass": 1, "inertia": 1, "position": [1.2, 0]}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
                      {"type": "revolute", "i": "crank.to", "j": "rod.from"},
                      {"type": "revolute", "i": "rod.to", "j": "slider"},
                      {"type": "translational", "i": "ground", "j": "slider", "axis_i": [1, 0], "axis_j": [1, 0]}],
      "drivers": [{"type": "absolute_angle", "name": "D", "i": "crank",
        "value": {"sum": [{"polynomial": [0.5880026035475675, 3, 0.5]},
                          {"step": {"t0": 0.5, "t1": 0.8, "from": 0, "to": 1}}]
}
}],
      "forces": [{"type": "spring_damper", "i": "slider", "j": ["ground", [2, 0]], "k": 20, "c": 8, "length": 0.5},
                 {"type": "point_force", "i": "rod.from", "force": [{"harmonic": {"amplitude": 30, "omega": 5}}, 0]}],
      "outputs": ["D.load", "D.power", "D.work", "energy"],
      "analyses": [{"type": "inverse_dynamics", )" +
           rows + R"(}, {"type": "dynamics", "from": "initial", "tolerance": 1e-12, )" + rows + "}]}";
  };
  const TextRun coarse = run_text(scene(R"("at": [0.3, 0.7, 2])"));
  ASSERT_EQ(coarse.outcome.exit_code, 0) << coarse.outcome.error_text << coarse.analysis().report.message;
  const TextRun fine = run_text(scene(R"("until": 2, "every": 0.01)"));
  for (const char* name : {"D.work", "energy.dissipated"}) {
    const std::vector<double> sums = coarse.column(name, 0), known = coarse.column(name, 1);
    ASSERT_EQ(sums.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(sums[k], known[k], 1e-6) << name;
      EXPECT_GT(std::abs(sums[k]), 0.5) << name;
    }
    EXPECT_NEAR(fine.last(name), sums.back(), 1e-7) << name;
  }
  for (double gap : coarse.column("energy.balance")) EXPECT_NEAR(gap, 0, 1e-7);
  EXPECT_FALSE(warns_of(coarse.analysis(), "summed up"));
}

// A load that sways thirty times while the body hardly moves: driver and load err alike, their sum shows nothing.
TEST(InverseDynamics, SumsUpWorkOfLoadsFasterThanTheMotion) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "absolute_x", "i": "b", "value": 0}, {"type": "absolute_y", "i": "b", "value": 0}],
    "drivers": [{"type": "absolute_angle", "name": "D", "i": "b", "value": {"polynomial": [0, 0.1]}}],
    "forces": [{"type": "torque", "i": "b", "torque": {"harmonic": {"amplitude": 5, "omega": 90}}}],
    "analyses": [{"type": "inverse_dynamics", "until": 2, "every": 2, "outputs": ["D.work", "energy.balance"]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  // D holds against the torque: 0.1 rad/s times minus its integral.
  EXPECT_NEAR(run.last("D.work"), -0.5 * (1 - std::cos(180.0)) / 90, 1e-9);
  EXPECT_FALSE(warns_of(run.analysis(), "summed up"));
}

}  // namespace
}  // namespace catena::testing
