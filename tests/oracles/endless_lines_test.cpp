// Bodies on straight guides that nothing holds along them, beside pendulums on bushings: no energy has a minimum there,
// and the answer says so, whatever the search met on its way.
#include <gtest/gtest.h>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string guide(const std::string& i, const std::string& j, double angle) {
  return R"({"type": "translational", "i": )" + i + R"(, "j": )" + j + R"(, "axis_i": )" +
         pair_of(std::cos(angle), std::sin(angle)) + "}";
}

/// A carriage on a guide, a second one on the first, and a pendulum that a bushing ties to the first; `held`: a spring
/// holds each along its guide, and there is an equilibrium.
std::string fault_of(unsigned seed, bool held) {
  RandomNumbers random(seed);
  const double one = random(-3, 3), two = random(-3, 3), k = random(100, 2000);
  const double gx = random(-10, 10), gy = random(-10, -1);
  const std::string springs =
      R"(, {"type": "spring_damper", "i": ["ground", [0, 0]], "j": ["a", [0, 0]], "k": 900, "length": 0},
      {"type": "spring_damper", "i": ["a", [0, 0]], "j": ["b", [0, 0]], "k": 700, "length": 0})";
  const TextRun run =
      run_text(R"({"catena": 1, "gravity": )" + pair_of(gx, gy) +
               R"(, "bodies": {"a": {"mass": 3, "inertia": 0.1}, "b": {"mass": 5, "inertia": 0.2, "position": )" +
               pair_of(0.3 * std::cos(two), 0.3 * std::sin(two)) + R"(},
      "pendulum": {"mass": 2, "inertia": 0.05, "position": [0.2, -0.1]}}, "constraints": [)" +
               guide(R"(["ground", [0, 0]])", R"(["a", [0, 0]])", one) + "," +
               guide(R"(["a", [0, 0]])", R"(["b", [0, 0]])", two) +
               R"(, {"type": "revolute", "i": ["a", [0.1, 0]], "j": ["pendulum", [-0.1, 0.1]]}],
      "forces": [{"type": "bushing", "i": ["a", [0.25, 0.1]], "j": ["pendulum", [0.05, 0.2]], "kx": )" +
               text_of(k) + R"(, "ky": )" + text_of(k / 2) + R"(, "kt": 5})" + (held ? springs : "") +
               R"(], "outputs": ["a.x"], "analyses": [{"type": "equilibrium"}]})");
  const Report& report = run.analysis().report;
  if (report.status != (held ? Status::ok : Status::unbounded))
    return std::string(to_string(report.status)) + ": " + report.message;
  return "";
}

TEST(EndlessLines, OfCarriagesThatNothingHolds) {
  expect_no_fault(1, size_of_test(40u, 2u), [](unsigned seed) { return fault_of(seed, false); });
}

// Two bodies that only each other and a stop beside them hold: they may turn about each other as they fall, which is no
// straight line, but falling side by side is one; whatever is asked for besides, nothing else is searched for.
TEST(EndlessLines, OfBodiesThatFallPastAStop) {
  const TextRun run = run_text(
      R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"a": {"mass": 1, "inertia": 0.4, "position": [0.2, -0.1]},
      "b": {"mass": 2, "inertia": 0.4, "angle": -0.3}},
      "drivers": [{"type": "displacement", "i": "b", "j": ["a", [-1.9, -0.3]], "axis_i": [-0.1, -1.3], "value": 1}],
      "forces": [{"type": "stop", "column": "a.x", "k": 1.1, "min": -0.9},
        {"type": "torsion_spring", "i": ["b", [-0.8, 0.7]], "j": ["a", [-0.1, -0.7]], "k": -1}],
      "outputs": ["b.y"], "analyses": [{"type": "equilibrium", "find": 2}]})");
  const Report& report = run.analysis().report;
  EXPECT_EQ(report.status, Status::unbounded) << report.message;
  EXPECT_NE(report.message.find("29.43 N move it without end along a straight line"), std::string::npos)
      << report.message;
}

// A body that slides off its curve is held by nothing there: equilibrium and motion name the same cause.
TEST(EndlessLines, OfABodyThatRunsOffTheEndOfItsCurve) {
  for (const std::string analysis : {R"("equilibrium")", R"("dynamics", "until": 1)"}) {
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "inertia": 1, "position": [0.1, 0]}},
        "constraints": [{"type": "absolute_angle", "i": "b", "value": 0},
          {"type": "point_on_curve", "name": "c", "i": "ground", "j": "b",
           "curve": {"spline": {"points": [[0, 0], [0.5, -0.2], [1, -0.3]]}}}],
        "outputs": ["b.x"], "analyses": [{"type": )" +
        analysis + "}]}");
    const Report& report = run.analysis().report;
    EXPECT_EQ(report.status, Status::singular) << analysis << report.message;
    EXPECT_NE(report.message.find("its curve is left at its end at (1, -0.3) m"), std::string::npos) << report.message;
  }
}

TEST(EndlessLines, AreNotThoseOfCarriagesOnSprings) {
  expect_no_fault(1, 40, [](unsigned seed) { return fault_of(seed, true); });
}

}  // namespace
}  // namespace catena::testing
