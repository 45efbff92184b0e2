// Joints with dry friction that share a load in ways that do not follow from equilibrium: beside a joint that nothing
// presses, beside a contact that leaves, in a mechanism with two freedoms; and what has no derivative there.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// Slides that a push of 1 + t N on the second one moves when it passes mu 10 N, though nothing presses the first.
TEST(JointsAtRest, OfWhatNothingPressesNothingIsAsked) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {"mass": 1, "inertia": 1},
    "b": {"mass": 1, "inertia": 1, "position": [0, 2]}}, "constraints": [
      {"type": "translational", "name": "A", "i": "ground", "j": "a", "axis_i": [1, 0]},
      {"type": "translational", "name": "B", "i": ["ground", [0, 2]], "j": "b", "axis_i": [1, 0]},
      {"type": "relative_x", "i": "a", "j": "b", "value": 0}],
    "forces": [{"type": "friction", "joint": "A", "mu": 0.5}, {"type": "friction", "name": "f", "joint": "B", "mu": 0.5},
      {"type": "point_force", "i": "b", "force": ["=1+t", -10]}],
    "outputs": ["a.x", "f.friction"], "analyses": [{"type": "dynamics", "until": 6, "every": 1}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.column("f.friction")[3], -4, 1e-9);
  EXPECT_NEAR(run.last("a.x"), 2.0 / 3, 1e-8);
}

// A particle leaves the slide that it lies on at 0.1 10 N, while that slide and another one go on holding.
TEST(JointsAtRest, HoldWhileAContactLeaves) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10], "bodies": {"a": {"mass": 1, "inertia": 1},
    "b": {"mass": 1, "inertia": 1, "position": [0, 2]}, "p": {"particle": true, "mass": 1, "position": [0, 0.1]}},
    "constraints": [{"type": "translational", "name": "A", "i": "ground", "j": "a", "axis_i": [1, 0]},
      {"type": "translational", "name": "B", "i": ["ground", [0, 2]], "j": "b", "axis_i": [1, 0]},
      {"type": "relative_x", "i": "a", "j": "b", "value": 0}],
    "forces": [{"type": "friction", "joint": "A", "mu": 0.5}, {"type": "friction", "joint": "B", "mu": 0.5},
      {"type": "contact", "i": "a", "j": "p", "mu": 0.1, "curve": {"line": {"point": [0, 0.1], "axis": [1, 0]}}},
      {"type": "point_force", "i": "p", "force": ["=4*t", 0]}],
    "outputs": ["p.x", "a.x"], "analyses": [{"type": "dynamics", "until": 1}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.last("p.x"), 4 * std::pow(0.75, 3) / 6, 1e-8);
  EXPECT_NEAR(run.last("a.x"), 0, 1e-12);
}

// Five bars with two freedoms stand on the friction of four or five pins, of which none slips though a torque changes.
// By the virtual powers of both freedoms pins hold what gravity and the torque ask for.
TEST(JointsAtRest, OfTwoFreedomsHoldBelowTheirLimits) {
  const double ends[5][2] = {{0, 0}, {0.3, 0.8}, {1.2, 1}, {1.9, 0.7}, {2, 0}};
  for (const int pins : {4, 5}) {
    std::vector<std::string> bodies, constraints, forces{R"_({"type": "torque", "i": "b0", "torque": "=3*sin(t)"})_"};
    std::string outputs = "\"b0.angle\", \"b3.angle\"";
    const auto end = [&](int k) { return "[" + text_of(ends[k][0]) + "," + text_of(ends[k][1]) + "]"; };
    for (int k = 0; k < 4; ++k)
      bodies.push_back("\"b" + std::to_string(k) + R"(": {"mass": 1, "rod": {"from": )" + end(k) + R"(, "to": )" +
                       end(k + 1) + "}}");
    for (int k = 0; k < 5; ++k) {
      const std::string n = std::to_string(k),
                        i = k == 0 ? R"(["ground", [0, 0]])" : "\"b" + std::to_string(k - 1) + ".to\"",
                        j = k == 4 ? R"(["ground", [2, 0]])" : "\"b" + n + ".from\"";
      constraints.push_back(R"({"type": "revolute", "name": "J)" + n + R"(", "i": )" + i + R"(, "j": )" + j + "}");
      if (k >= pins) continue;
      forces.push_back(R"({"type": "friction", "name": "f)" + n + R"(", "joint": "J)" + n +
                       R"(", "mu": 0.6, "radius": 0.5})");
      outputs += ", \"f" + n + ".friction\"";
    }
    const TextRun run =
        run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + list_of(bodies) + R"(}, "constraints": [)" +
                 list_of(constraints) + R"(], "forces": [)" + list_of(forces) + R"(], "outputs": [)" + outputs +
                 R"(], "analyses": [{"type": "dynamics", "until": 10, "every": 1}]})");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    EXPECT_TRUE(field<std::vector<FieldRecord>>(run, "events").empty());
    const auto t = run.column("t"), first = run.column("b0.angle"), last = run.column("b3.angle");
    for (std::size_t row = 0; row < t.size(); ++row) {
      EXPECT_NEAR(first[row], first[0], 1e-12);
      EXPECT_NEAR(last[row], last[0], 1e-12);
      // Rates of the bars with the first one's, and the last one's, given: x0 = x4 of the loop.
      for (const bool by_first : {true, false}) {
        double rate[4] = {by_first ? 1.0 : 0.0, 0, 0, by_first ? 0.0 : 1.0}, side[2] = {0, 0};
        const auto way = [&](int k, int axis) {
          return axis == 0 ? ends[k][1] - ends[k + 1][1] : ends[k + 1][0] - ends[k][0];
        };
        for (const int axis : {0, 1}) side[axis] = -rate[0] * way(0, axis) - rate[3] * way(3, axis);
        const double determinant = way(1, 0) * way(2, 1) - way(2, 0) * way(1, 1);
        rate[1] = (side[0] * way(2, 1) - side[1] * way(2, 0)) / determinant;
        rate[2] = (way(1, 0) * side[1] - way(1, 1) * side[0]) / determinant;
        double power = 3 * std::sin(t[row]) * rate[0], height = 0, size = 0;
        for (int k = 0; k < 4; ++k) {
          power -= 9.81 * (height + rate[k] * way(k, 1) / 2);
          size += 9.81 * std::abs(height + rate[k] * way(k, 1) / 2);
          height += rate[k] * way(k, 1);
        }
        for (int k = 0; k < pins; ++k) {
          const double turn = (k < 4 ? rate[k] : 0) - (k > 0 ? rate[k - 1] : 0);
          power += run.column("f" + std::to_string(k) + ".friction")[row] * turn;
        }
        EXPECT_NEAR(power, 0, 1e-8 * size) << pins << " pins, row " << row;
      }
    }
  }
}

// How slides share friction changes with their coefficients, which is not differentiated: no derivative of it. Those of
// a slide beside them, which slows down from 5 m/s by its own friction, are there.
TEST(JointsAtRest, SharesHaveNoDerivatives) {
  const TextRun run =
      run_text(R"({"catena": 1, "parameters": {"m": 0.3, "n": 0.2}, "bodies": {"a": {"mass": 1, "inertia": 1},
    "b": {"mass": 1, "inertia": 1, "position": [0, 2]},
    "c": {"mass": 1, "inertia": 1, "position": [0, 4], "velocity": [5, 0]}}, "constraints": [
      {"type": "translational", "name": "A", "i": "ground", "j": "a", "axis_i": [1, 0]},
      {"type": "translational", "name": "B", "i": ["ground", [0, 2]], "j": "b", "axis_i": [1, 0]},
      {"type": "translational", "name": "C", "i": ["ground", [0, 4]], "j": "c", "axis_i": [1, 0]},
      {"type": "relative_x", "i": "a", "j": "b", "value": 0}],
    "forces": [{"type": "friction", "name": "f", "joint": "A", "mu": "m"}, {"type": "friction", "joint": "B", "mu": "n"},
      {"type": "friction", "name": "h", "joint": "C", "mu": "m"}, {"type": "point_force", "i": "c", "force": [0, -10]},
      {"type": "point_force", "i": "a", "force": [3, -10]}, {"type": "point_force", "i": "b", "force": [0, -10]}],
    "outputs": ["a.x", "f.friction", "c.vx", "h.friction"], "analyses": [{"type": "sensitivity", "parameters": ["m", "n"], "mode": "forward",
      "of": {"type": "dynamics", "until": 1}}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.last("f.friction"), -1.8, 1e-9);
  EXPECT_EQ(run.last("d(a.x)/d(n)"), 0);
  EXPECT_TRUE(std::isnan(run.last("d(f.friction)/d(n)")));
  EXPECT_NEAR(run.last("c.vx"), 2, 1e-9);
  EXPECT_NEAR(run.last("d(c.vx)/d(m)"), -10, 1e-8);
  EXPECT_NEAR(run.last("d(h.friction)/d(m)"), -10, 1e-8);
}

}  // namespace
}  // namespace catena::testing
