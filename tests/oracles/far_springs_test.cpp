// Places of rest far from the start, and energies that fall for ever: which is which is no matter of how far a search
// went.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A held particle, and one that hangs at x = 1 m; they are the extent of the scene.
std::string two_particles(const std::string& forces, bool guided) {
  return R"({"catena": 1, "gravity": [0, -10], "bodies": {"a": {"particle": true, "mass": 1}, "b": {"particle": true, )"
         R"("mass": 1, "position": [1, 0]}}, "constraints": [{"type": "absolute_x", "i": "a", "value": 0}, )"
         R"({"type": "absolute_y", "i": "a", "value": 0})" +
         std::string(guided ? R"(, {"type": "absolute_x", "i": "b", "value": 1})" : "") + R"(], "forces": [)" + forces +
         R"(], "outputs": ["b.x", "b.y"], "analyses": [{"type": "equilibrium"}]})";
}

TEST(FarSprings, HoldWhereTheyBeginToHold) {
  for (const double length : {1e3, 1e5, 1e6}) {
    const std::string cable = R"({"type": "cable", "i": "ground", "j": "b", "length": )" + text_of(length);
    const TextRun elastic = run_text(two_particles(cable + R"(, "k": 100})", false));
    ASSERT_TRUE(elastic.analysis().report.ok()) << length << elastic.analysis().report.message;
    EXPECT_NEAR(elastic.last("b.y"), -(length + 0.1), 1e-9 + 1e-15 * length);
    const TextRun rigid = run_text(two_particles(cable + "}", true));
    ASSERT_TRUE(rigid.analysis().report.ok()) << length << rigid.analysis().report.message;
    EXPECT_NEAR(rigid.last("b.y"), -std::sqrt(length * length - 1), 1e-9 + 1e-15 * length);
    const TextRun floor =
        run_text(two_particles(R"({"type": "contact", "i": "ground", "j": "b", "curve": {"line": {"point": [0, -)" +
                                   text_of(length) + R"(], "axis": [1, 0]}}})",
                               true));
    ASSERT_TRUE(floor.analysis().report.ok()) << length << floor.analysis().report.message;
    EXPECT_NEAR(floor.last("b.y"), -length, 1e-9 + 1e-15 * length);
    // Held by a spring that is soft: k = m g / length.
    const TextRun soft =
        run_text(two_particles(R"({"type": "spring_damper", "i": ["ground", [1, 0]], "j": "b", "length": 0, "k": )" +
                                   text_of(10 / length) + "}",
                               true));
    ASSERT_TRUE(soft.analysis().report.ok()) << length << soft.analysis().report.message;
    EXPECT_NEAR(soft.last("b.y"), -length, 1e-9 * length);
  }
}

TEST(FarSprings, TurnAWheelAsFarAsTheyAreSoft) {
  for (const double turned : {1e2, 1e4, 1e5, 1e8}) {
    const TextRun run =
        run_text(R"({"catena": 1, "bodies": {"w": {"mass": 1, "inertia": 1}}, "constraints": [
        {"type": "revolute", "i": "ground", "j": "w"}], "forces": [{"type": "torsion_spring", "i": "ground", "j": "w",
        "k": 1, "angle": 0}, {"type": "torque", "i": "w", "torque": )" +
                 text_of(turned) + R"(}], "outputs": ["w.angle"], "analyses": [{"type": "equilibrium"}]})");
    ASSERT_TRUE(run.analysis().report.ok()) << turned << run.analysis().report.message;
    EXPECT_NEAR(run.last("w.angle"), turned, 1e-12 * turned);
  }
}

TEST(FarSprings, DoNotHoldWhatFallsForEver) {
  const TextRun free = run_text(two_particles(R"({"type": "spring_damper", "i": "ground", "j": "a", "k": 1})", true));
  EXPECT_EQ(free.analysis().report.status, Status::unbounded) << free.analysis().report.message;
}

TEST(FarSprings, APendulumUnderATorqueRestsOrTurnsForEver) {
  // m g l = 10 N m; torques around that.
  for (const double torque : {5.0, 9.9, 10.1, 20.0, 1000.0}) {
    const TextRun run =
        run_text(R"({"catena": 1, "gravity": [0, -10], "bodies": {"p": {"rod": {"from": [0, 0],
        "to": [0, -2]}, "mass": 1}}, "constraints": [{"type": "revolute", "i": "ground", "j": "p.from"}],
        "forces": [{"type": "torque", "i": "p", "torque": )" +
                 text_of(torque) + R"(}], "outputs": ["p.angle"], "analyses": [{"type": "equilibrium"}]})");
    const Report& report = run.analysis().report;
    if (torque > 10) {
      EXPECT_EQ(report.status, Status::unbounded) << torque << report.message;
      continue;
    }
    ASSERT_TRUE(report.ok()) << torque << report.message;
    EXPECT_NEAR(run.last("p.angle"), std::asin(torque / 10) - std::numbers::pi / 2, 1e-9);
  }
}

}  // namespace
}  // namespace catena::testing
