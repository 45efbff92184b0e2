// Equilibria of small scenes with contacts, stops and cables against closed forms; what is refused, and how it is said.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/analysis/statics/solvers/static_nlopt.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

void expect_ok(const TextRun& run) {
  ASSERT_TRUE(run.outcome.error_text.empty()) << run.outcome.error_text;
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
}

bool warns(const TextRun& run, const std::string& part) {
  for (const std::string& warning : run.analysis().report.warnings) {
    if (warning.find(part) != std::string::npos) return true;
  }
  return false;
}

// A bob of 2 kg under 10 m/s^2 and whatever else holds it: 20 N.
std::string bob(const std::string& place, const std::string& forces, const std::string& outputs,
                const std::string& keys = "") {
  return R"({"catena": 1, "gravity": [0, -10],
    "bodies": {"bob": {"particle": true, "mass": 2, "position": )" +
         place + "}}, \"forces\": [" + forces + R"(], "analyses": [{"type": "equilibrium")" + keys +
         R"(}], "outputs": [)" + outputs + "]}";
}

// Planes at 30 and 60 degrees to the horizontal, free above: the forces are W sin 60 / sin 90 and W sin 30 / sin 90.
const std::string groove = R"(
  {"type": "contact", "name": "left", "i": "ground", "j": "bob", "radius": 0.1,
   "curve": {"line": {"point": [0, 0], "axis": [1, "=-sqrt(3)*1"]}}},
  {"type": "contact", "name": "right", "i": "ground", "j": "bob", "radius": 0.1,
   "curve": {"line": {"point": [0, 0], "axis": ["=sqrt(3)*1", 1]}}})";
const std::string groove_columns = R"("bob.x", "bob.y", "left.force", "right.force", "left.gap", "right.gap")";

void check_groove(const TextRun& run) {
  expect_ok(run);
  EXPECT_NEAR(run.last("left.force"), 20 * std::sin(std::numbers::pi / 6), 1e-11);
  EXPECT_NEAR(run.last("right.force"), 20 * std::cos(std::numbers::pi / 6), 1e-11);
  EXPECT_NEAR(run.last("left.gap"), 0, 1e-12);
  EXPECT_NEAR(run.last("right.gap"), 0, 1e-12);
  EXPECT_TRUE(field<bool>(run, "stable"));
  EXPECT_EQ(field<std::vector<std::string>>(run, "active"), (std::vector<std::string>{"left", "right"}));
}

TEST(OneSided, DiscInAGroove) {
  check_groove(run_text(bob("[0.3, 2]", groove, groove_columns)));
  // From below both planes too.
  check_groove(run_text(bob("[-0.7, -3]", groove, groove_columns)));
}

TEST(OneSided, EverySolverFindsTheSame) {
  check_groove(run_text(bob("[0.3, 2]", groove, groove_columns, R"(, "solver": "newton")")));
  if (ipopt_is_built_in()) check_groove(run_text(bob("[0.3, 2]", groove, groove_columns, R"(, "solver": "ipopt")")));
  if (nlopt_is_built_in()) check_groove(run_text(bob("[0.3, 2]", groove, groove_columns, R"(, "solver": "nlopt")")));
}

TEST(OneSided, InsideAndOutsideOfACircle) {
  const std::string circle = R"({"type": "contact", "name": "bowl", "i": "ground", "j": "bob",
    "curve": {"circle": {"centre": [1, 1], "radius": 0.5}})";
  const TextRun inside =
      run_text(bob("[1.2, 1.1]", circle + ", \"side\": -1}", R"("bob.x", "bob.y", "bowl.force", "bowl.fy")"));
  expect_ok(inside);
  EXPECT_NEAR(inside.last("bob.x"), 1, 1e-12);
  EXPECT_NEAR(inside.last("bob.y"), 0.5, 1e-12);
  EXPECT_NEAR(inside.last("bowl.force"), 20, 1e-11);
  EXPECT_NEAR(inside.last("bowl.fy"), 20, 1e-11);
  // On top of the circle it does not stay: nothing holds it then.
  const TextRun outside = run_text(bob("[1, 1.7]", circle + "}", R"("bob.y")"));
  EXPECT_EQ(outside.outcome.exit_code, 1);
  const TextRun balanced =
      run_text(bob("[1, 1.7]", circle + "}", R"("bob.y", "bowl.force")", R"(, "accept": "stationary")"));
  expect_ok(balanced);
  EXPECT_NEAR(balanced.last("bob.y"), 1.5, 1e-12);
  EXPECT_NEAR(balanced.last("bowl.force"), 20, 1e-11);
  EXPECT_FALSE(field<bool>(balanced, "stable"));
}

TEST(OneSided, OnlyTheShorterCableIsTaut) {
  const TextRun run =
      run_text(bob("[0.3, 0.2]",
                   R"({"type": "cable", "name": "a", "i": ["ground", [0, 1]], "j": "bob", "length": 1.5},
        {"type": "cable", "name": "b", "i": ["ground", [0, 1]], "j": "bob", "length": 1.25})",
                   R"("bob.x", "bob.y", "a.force", "a.gap", "b.force", "b.gap", "b.length")"));
  expect_ok(run);
  EXPECT_NEAR(run.last("bob.x"), 0, 1e-11);
  EXPECT_NEAR(run.last("bob.y"), -0.25, 1e-12);
  EXPECT_EQ(run.last("a.force"), 0);
  EXPECT_NEAR(run.last("a.gap"), 0.25, 1e-12);
  EXPECT_NEAR(run.last("b.force"), 20, 1e-11);
  EXPECT_NEAR(run.last("b.gap"), 0, 1e-12);
  EXPECT_NEAR(run.last("b.length"), 1.25, 1e-12);
}

TEST(OneSided, ElasticCablesPullOnly) {
  const TextRun run =
      run_text(bob("[0, -2]",
                   R"({"type": "cable", "name": "up", "i": ["ground", [0, 1]], "j": "bob", "length": 1, "k": 400},
        {"type": "cable", "i": "bob", "j": ["ground", [0, -1]], "length": 3, "k": 100})",
                   R"("bob.y", "up.force", "up.gap", "cable#2.force", "cable#2.gap")"));
  expect_ok(run);
  EXPECT_NEAR(run.last("bob.y"), -0.05, 1e-12);
  EXPECT_NEAR(run.last("up.force"), 20, 1e-10);
  EXPECT_NEAR(run.last("up.gap"), -0.05, 1e-12);
  EXPECT_EQ(run.last("cable#2.force"), 0);
  EXPECT_NEAR(run.last("cable#2.gap"), 3 - 0.95, 1e-12);
}

TEST(OneSided, CablesAreNumberedTogether) {
  const TextRun run =
      run_text(bob("[0, -1]",
                   R"({"type": "cable", "i": "ground", "j": "bob", "length": 1, "k": 400},
        {"type": "cable", "i": ["ground", [3, 0]], "j": "bob", "length": 9},
        {"type": "cable", "i": ["ground", [-3, 0]], "j": "bob", "length": 9, "k": 10})",
                   R"("cable#1.force", "cable#2.force", "cable#3.force", "cable#2.gap", "cable#3.gap")"));
  expect_ok(run);
  EXPECT_NEAR(run.last("cable#1.force"), 20, 1e-10);
  EXPECT_EQ(run.last("cable#2.force"), 0);
  EXPECT_EQ(run.last("cable#3.force"), 0);
  EXPECT_NEAR(run.last("cable#2.gap"), run.last("cable#3.gap"), 1e-11);
}

// A bar of 2 m and 3 kg on a pin, horizontal at angle 0, sinks onto a stop.
std::string bar(const std::string& stop, const std::string& outputs, const std::string& angle = "0") {
  return R"({"catena": 1, "gravity": [0, -10],
    "bodies": {"bar": {"mass": 3, "inertia": 1, "centroid": [1, 0], "angle": )" +
         angle + R"(, "points": {"tip": [2, 0]}}},
    "forces": [)" +
         stop + R"(],
    "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "bar"}],
    "analyses": [{"type": "equilibrium"}], "outputs": [)" +
         outputs + "]}";
}

TEST(OneSided, StopsOfAJointsAngle) {
  const double low = -std::numbers::pi / 6, torque = 30 * std::cos(low);
  const auto check = [&](const TextRun& run) {
    expect_ok(run);
    EXPECT_NEAR(run.last("bar.angle"), low, 1e-12);
    EXPECT_NEAR(run.last("stop.force"), torque, 1e-10);
    EXPECT_NEAR(run.last("stop.gap"), 0, 1e-12);
    EXPECT_TRUE(field<bool>(run, "stable"));
  };
  const std::string columns = R"("bar.angle", "stop.force", "stop.gap")";
  check(run_text(bar(R"({"type": "stop", "name": "stop", "column": "A.angle", "min": "-30 deg"})", columns)));
  check(run_text(
      bar(R"({"type": "stop", "name": "stop", "column": "A.angle", "min": "-30 deg", "max": "80 deg"})", columns)));
  check(run_text(bar(R"({"type": "stop", "name": "stop", "column": "bar.angle", "min": "-30 deg"})", columns)));
  // Beyond its upper bound at first: it falls over to the other side only if it may.
  check(run_text(bar(R"({"type": "stop", "name": "stop", "column": "A.angle", "min": "-30 deg", "max": "80 deg"})",
                     columns, "1.5")));
}

TEST(OneSided, AnOpenStopLeavesTheBarHanging) {
  const TextRun run =
      run_text(bar(R"({"type": "stop", "name": "stop", "column": "A.angle", "min": "-100 deg", "max": "80 deg"})",
                   R"("bar.angle", "stop.force", "stop.gap", "A.fy")"));
  expect_ok(run);
  EXPECT_NEAR(run.last("bar.angle"), -std::numbers::pi / 2, 1e-10);
  EXPECT_EQ(run.last("stop.force"), 0);
  EXPECT_NEAR(run.last("stop.gap"), std::numbers::pi / 18, 1e-10);
  EXPECT_TRUE(field<std::vector<std::string>>(run, "active").empty());
}

TEST(OneSided, StopsOfACoordinateAndOfALength) {
  const TextRun tip = run_text(bar(R"({"type": "stop", "name": "stop", "column": "bar.tip.y", "min": "-1 m"})",
                                   R"("bar.tip.y", "stop.force", "stop.fy")"));
  expect_ok(tip);
  EXPECT_NEAR(tip.last("bar.tip.y"), -1, 1e-12);
  EXPECT_NEAR(tip.last("stop.force"), 15, 1e-10);
  EXPECT_NEAR(tip.last("stop.fy"), 15, 1e-10);
  // A spring of 10 N/m would stretch by 2 m; its buffer ends that at 0.5 m.
  const TextRun buffer = run_text(bob("[0, -1]",
                                      R"({"type": "stop", "name": "stop", "column": "s.length", "max": 1.5},
        {"type": "spring_damper", "name": "s", "i": "ground", "j": "bob", "k": 10, "length": 1})",
                                      R"("bob.y", "s.force", "stop.force")"));
  expect_ok(buffer);
  EXPECT_NEAR(buffer.last("bob.y"), -1.5, 1e-12);
  EXPECT_NEAR(buffer.last("s.force"), 5, 1e-10);
  EXPECT_NEAR(buffer.last("stop.force"), 15, 1e-10);
}

TEST(OneSided, StopsMayStandBeforeWhatTheyBoundAndInBlocks) {
  // Three bars side by side, each on its own stop, k 10 degrees below the horizontal.
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
    "replicate": [{"count": 3, "forces": [{"type": "stop", "name": "stop{k}", "column": "pin{k}.angle", "min": "=-k*pi/18"}],
      "bodies": {"bar{k}": {"mass": 1, "inertia": 0.1, "position": ["=5*k + 1", 0]}},
      "constraints": [{"type": "revolute", "name": "pin{k}", "i": ["ground", ["=5*k", 0]], "j": ["bar{k}", [-1, 0]]}]}],
    "analyses": [{"type": "equilibrium"}], "outputs": ["bar1.angle", "bar3.angle", "stop1.force", "stop3.force"]})");
  expect_ok(run);
  EXPECT_NEAR(run.last("bar1.angle"), -std::numbers::pi / 18, 1e-12);
  EXPECT_NEAR(run.last("bar3.angle"), -std::numbers::pi / 6, 1e-12);
  EXPECT_NEAR(run.last("stop1.force"), 10 * std::cos(std::numbers::pi / 18), 1e-10);
  EXPECT_NEAR(run.last("stop3.force"), 10 * std::cos(std::numbers::pi / 6), 1e-10);
}

TEST(OneSided, SlidesOfJoints) {
  // A carriage of 2 kg on rails at 30 degrees, held by a buffer 0.4 m down.
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
    "bodies": {"carriage": {"mass": 2, "inertia": 1, "angle": "30 deg"}},
    "constraints": [{"type": "translational", "name": "rails", "i": "ground", "j": "carriage", "axis_i": ["=sqrt(3)*1", 1]}],
    "forces": [{"type": "stop", "name": "buffer", "column": "rails.slide", "min": "-0.4 m", "max": "2 m"}],
    "analyses": [{"type": "equilibrium"}], "outputs": ["rails.slide", "buffer.force", "buffer.gap"]})");
  expect_ok(run);
  EXPECT_NEAR(run.last("rails.slide"), -0.4, 1e-12);
  EXPECT_NEAR(run.last("buffer.force"), 10, 1e-11);
  EXPECT_NEAR(run.last("buffer.gap"), 0, 1e-12);
}

TEST(OneSided, TouchingWithoutForceIsSaid) {
  // The spring carries the bob exactly where the floor begins.
  const TextRun run =
      run_text(bob("[0, -0.7]",
                   R"({"type": "spring_damper", "i": ["ground", [0, 1]], "j": "bob", "k": 20, "length": 1},
        {"type": "contact", "name": "floor", "i": "ground", "j": "bob", "curve": {"line": {"point": [0, -1], "axis": [1, 0]}}})",
                   R"("bob.y", "floor.force")"));
  expect_ok(run);
  EXPECT_NEAR(run.last("bob.y"), -1, 1e-9);
  EXPECT_TRUE(warns(run, "cannot be distinguished from rounding")) << run.analysis().report.warnings.size();
  EXPECT_TRUE(warns(run, "\"floor\""));
  EXPECT_TRUE(field<bool>(run, "stable"));
}

TEST(OneSided, WhatHasNoEquilibriumIsNoAnswer) {
  const TextRun slide = run_text(bob("[0, 1]",
                                     R"({"type": "contact", "name": "slope", "i": "ground", "j": "bob",
        "curve": {"line": {"point": [0, 0], "axis": [1, -0.1]}}})",
                                     R"("bob.y")"));
  EXPECT_EQ(slide.outcome.exit_code, 1);
  EXPECT_NE(slide.analysis().report.status, Status::ok);
  EXPECT_FALSE(slide.analysis().report.message.empty());
  const TextRun contradiction = run_text(bob("[0, 1]",
                                             R"({"type": "stop", "name": "high", "column": "bob.y", "min": 1},
        {"type": "stop", "name": "low", "column": "bob.y", "max": 0})",
                                             R"("bob.y")"));
  EXPECT_EQ(contradiction.outcome.exit_code, 1);
  EXPECT_NE(contradiction.analysis().report.message.find("violated"), std::string::npos)
      << contradiction.analysis().report.message;
}

TEST(OneSided, ModesLeaveOutWhatIsOpen) {
  const std::string start = R"({"catena": 1, "gravity": [0, -10], "bodies": {"bob": {"particle": true, "mass": 2}},
    "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "bob",
      "curve": {"line": {"point": [0, -1], "axis": [1, 0]}}}], "analyses": [{"type": )";
  const TextRun modes = run_text(start + R"("modes"}]})");
  expect_ok(modes);
  EXPECT_TRUE(warns(modes, "no equilibrium"));
  ASSERT_EQ(modes.column("omega2").size(), 2u);
  EXPECT_EQ(modes.column("omega2").front(), 0);
  const TextRun check = run_text(start + R"("check"}]})");
  EXPECT_EQ(check.outcome.exit_code, 0);
  EXPECT_TRUE(check.analysis().report.warnings.empty());
}

TEST(OneSided, CheckAndAssembleNameWhatIsViolated) {
  for (const std::string& analysis : {std::string("check"), std::string("assemble")}) {
    const TextRun run = run_text(R"({"catena": 1, "bodies": {"bob": {"particle": true, "position": [0, -3]}},
    "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "bob",
      "curve": {"line": {"point": [0, -1], "axis": [1, 0]}}}], "analyses": [{"type": ")" +
                                 analysis + R"("}]})");
    expect_ok(run);
    EXPECT_TRUE(warns(run, "contact \"floor\" is violated by 2")) << analysis;
  }
}

}  // namespace
}  // namespace catena::testing
