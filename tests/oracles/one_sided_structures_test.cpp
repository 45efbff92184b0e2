// Paths and buckling of structures with one-sided elements against closed forms: a shallow truss, a rope over a peg, a
// column.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "oracles/analysis_fields.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// A shallow truss of two bars snaps through: past its limit point the load falls, until the apex lies on a stop and the
// load rises again. P(y) = 2 k y (l0 / l - 1), l^2 = b^2 + y^2.
TEST(OneSidedStability, APathTurnsBackWhereAStopCloses) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers draw(seed);
    const double b = 1, h = draw(0.2, 0.4), k = draw(500, 1500), l0 = std::hypot(b, h);
    const auto load = [&](double y) { return 2 * k * y * (l0 / std::hypot(b, y) - 1); };
    const double top = std::sqrt(std::pow(l0 * b * b, 2.0 / 3) - b * b);  // where P'(y) = 0
    const double stop = draw(-0.3, 0.6) * top, most = load(top), to = 1.4 * most;
    const TextRun run = run_text(fmt::format(
        R"({{"catena": 1, "parameters": {{"P": 0}}, "bodies": {{"apex": {{"particle": true, "mass": 1,
        "position": [0, {0:.17g}]}}}}, "constraints": [{{"type": "absolute_x", "i": "apex", "value": 0}}],
        "forces": [{{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "apex", "k": {1:.17g}, "length": {2:.17g}}},
          {{"type": "spring_damper", "i": ["ground", [1, 0]], "j": "apex", "k": {1:.17g}, "length": {2:.17g}}},
          {{"type": "point_force", "i": "apex", "force": [0, "=-P"]}},
          {{"type": "stop", "name": "stop", "column": "apex.y", "min": {3:.17g}}}],
        "outputs": ["apex.y", "stop.force"],
        "analyses": [{{"type": "path", "parameter": "P", "to": {4:.17g}}}]}})",
        h, k, l0, stop, to));
    ASSERT_FINE(run);
    const auto critical = field_of<std::vector<FieldRecord>>(run.analysis(), "critical");
    ASSERT_EQ(critical.size(), 1u);
    EXPECT_NEAR(value_of<double>(critical[0], "value"), most, 1e-8 * most);
    const auto changes = field_of<std::vector<FieldRecord>>(run.analysis(), "changes");
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_EQ(value_of<std::string>(changes[0], "kind"), "closes");
    EXPECT_NEAR(value_of<double>(changes[0], "value"), load(stop), 1e-8 * most);
    EXPECT_NEAR(run.last("P"), to, 1e-12 * to);
    EXPECT_NEAR(run.last("apex.y"), stop, 1e-12);
    EXPECT_NEAR(run.last("stop.force"), to - load(stop), 1e-8 * to);
    EXPECT_EQ(field_of<std::vector<double>>(run.analysis(), "negative_modes").back(), 0);
  }
}

/// A weight of 2 kg on a rope that comes in level over the top of a peg, and `load` at it.
std::string weight_over_a_peg(const std::string& stiffness, const std::string& load, double to) {
  return fmt::format(R"({{"catena": 1, "parameters": {{"P": 0}}, "gravity": [0, -9.81], "bodies": {{"b": {{
    "particle": true, "mass": 2, "position": [0.1, -1]}}}}, "forces": [{{"type": "rope", "name": "rope",
    "i": ["ground", [-1, 0.1]], "over": [{{"at": ["ground", [0, 0]], "radius": 0.1, "side": -1}}], "j": "b"{}}},
    {{"type": "point_force", "i": "b", "force": {}}}], "outputs": ["b.x", "b.y", "rope.force"],
    "analyses": [{{"type": "path", "parameter": "P", "to": {:.17g}}}]}})",
                     stiffness, load, to);
}

TEST(OneSidedStability, PathsOfRopesOverAPeg) {
  for (const std::string stiffness : {"", R"(, "k": 2000)"}) {
    SCOPED_TRACE(stiffness);
    const TextRun down = run_text(weight_over_a_peg(stiffness, R"([0, "=-P"])", 50));
    ASSERT_FINE(down);
    const std::vector<double> P = down.column("P");
    for (std::size_t row = 0; row < P.size(); ++row) {
      EXPECT_NEAR(down.column("rope.force")[row], 2 * 9.81 + P[row], 1e-8);
      EXPECT_NEAR(down.column("b.x")[row], 0.1, 1e-9);
      EXPECT_NEAR(down.column("b.y")[row], -1 - (stiffness.empty() ? 0 : (2 * 9.81 + P[row]) / 2000), 1e-9);
    }
    // Drawn to the side and up, the rope leaves the peg where the load carries the weight: P = 2 g.
    const TextRun up = run_text(weight_over_a_peg(stiffness, R"(["=0.3*P", "=P"])", 30));
    EXPECT_EQ(up.outcome.exit_code, 1);
    EXPECT_EQ(up.analysis().report.status, Status::singular);
    EXPECT_NE(up.analysis().report.message.find("rope \"rope\""), std::string::npos) << up.analysis().report.message;
    EXPECT_NE(up.analysis().report.message.find("leaves a pulley"), std::string::npos) << up.analysis().report.message;
    EXPECT_LE(up.last("P"), 2 * 9.81);
    EXPECT_GT(up.last("P"), 2 * 9.81 - 3);
  }
}

/// A column of four rods between a pin and a slide, springs at its joints, pressed by P; at mid-height a stop against
/// which a lateral force `push` holds it, N.
std::string column(double c, double l, const std::string& push, const std::string& analyses) {
  std::string bodies, constraints = R"({"type": "revolute", "i": "ground", "j": "r0.from"})", forces;
  for (int n = 0; n < 4; ++n) {
    bodies += fmt::format(R"({}"r{}": {{"rod": {{"from": [{:.17g}, 0], "to": [{:.17g}, 0]}}}})", n > 0 ? ", " : "", n,
                          n * l, (n + 1) * l);
    if (n == 0) continue;
    constraints += fmt::format(R"(, {{"type": "revolute", "i": "r{}.to", "j": "r{}.from"}})", n - 1, n);
    forces += fmt::format(R"({{"type": "torsion_spring", "i": "r{}", "j": "r{}", "k": {:.17g}}}, )", n - 1, n, c);
  }
  return fmt::format(R"({{"catena": 1, "parameters": {{"P": 0}}, "bodies": {{{}}}, "constraints": [{},
    {{"type": "absolute_y", "i": "r3.to", "value": 0}}], "forces": [{}
    {{"type": "point_force", "i": "r3.to", "force": ["=-P", 0]}},
    {{"type": "point_force", "i": "r1.to", "force": [0, "={}"]}},
    {{"type": "stop", "name": "stop", "column": "r1.to.y", "min": 0}}], "analyses": [{}]}})",
                     bodies, constraints, forces, push, analyses);
}

// Of four rods: 4 c / l sin^2(j pi / 8). Held at mid-height it buckles in two halves, j = 2; with nothing that presses
// it there the stop is weak and taken as open, j = 1.
TEST(OneSidedStability, BucklingOfAColumnThatAStopHoldsAtMidHeight) {
  const double c = 3, l = 0.25;
  const auto load = [&](int j) { return 4 * c / l * std::pow(std::sin(j * std::numbers::pi / 8), 2); };
  const std::string analysis = R"({"type": "buckling", "parameter": "P"})";
  const TextRun held = run_text(column(c, l, "-2", analysis));
  ASSERT_FINE(held);
  EXPECT_NEAR(held.first("P"), load(2), 1e-9 * load(2));
  EXPECT_EQ(field_of<std::vector<std::string>>(held.analysis(), "active"), std::vector<std::string>{"stop"});
  EXPECT_FALSE(warns(held.analysis(), "would not hold"));
  const TextRun weak = run_text(column(c, l, "0", analysis));
  ASSERT_FINE(weak);
  EXPECT_NEAR(weak.first("P"), load(1), 1e-9 * load(1));
  EXPECT_TRUE(warns(weak.analysis(), "touching without a force"));
  // The load takes the push away before it is reached.
  const TextRun opens = run_text(column(c, l, "P - 2", analysis));
  ASSERT_FINE(opens);
  EXPECT_NEAR(opens.first("P"), load(2), 1e-9 * load(2));
  EXPECT_TRUE(warns(opens.analysis(), "\"stop\""));
  EXPECT_TRUE(warns(opens.analysis(), "would not hold"));
}

}  // namespace
}  // namespace catena::testing
