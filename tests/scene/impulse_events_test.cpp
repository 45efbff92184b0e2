// Blows: events with an impulse, against balances of momentum.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string event(const std::string& impulse) {
  return R"("events": [{"name": "blow", "when": "t", "value": 0.1, "impulse": )" + impulse + "}]";
}

// A rod hangs from a pin and is hit at its end: it turns about the pin, and the pin's own impulse does no work.
TEST(ImpulseEvents, StrikeARodOnAPin) {
  const double m = 2, length = 0.8, inertia = 0.15, about = inertia + m * length * length / 4, P = 0.5;
  const double omega = P * length / about, later = 1e-4;
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"rod": {"mass": 2, "inertia": 0.15, "position": [0, -0.4], "points": {"tip": [0, -0.4]}}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": ["rod", [0, 0.4]]}],
    "outputs": ["rod.omega", "energy.balance", "energy.dissipated"],
    "analyses": [{"type": "dynamics", "at": [0.05, 0.1001], "tolerance": 1e-11, )" +
                               event(R"({"i": "rod.tip", "value": [0.5, 0]})") + "}]}");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.first("rod.omega"), 0, 1e-12);
  // It swings back by less than omega (m g l / 2 about) later^2 / 2 meanwhile.
  EXPECT_NEAR(run.last("rod.omega"), omega, 20 * omega * later * later);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-10);
  EXPECT_NEAR(run.last("energy.dissipated"), 0, 1e-10);
  const auto events = field<std::vector<FieldRecord>>(run, "events");
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(std::get<std::string>(events[0][3].second), "impulse");
}

// A ball that lies on a floor of restitution 1/2 is struck downwards: it comes back with half of what it was given.
TEST(ImpulseEvents, StrikeABallAgainstTheFloor) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
    "bodies": {"ball": {"particle": true, "mass": 2}},
    "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "ball", "restitution": 0.5,
                "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
    "outputs": ["ball.y", "energy.balance", "energy.dissipated"],
    "analyses": [{"type": "dynamics", "at": [0.15], "tolerance": 1e-11, )" +
                               event(R"({"i": "ball", "value": [0, -4]})") + "}]}");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.last("ball.y"), 1 * 0.05 - 5 * 0.0025, 1e-10);
  EXPECT_NEAR(run.last("energy.dissipated"), 2 * (4 - 1) / 2.0, 1e-9);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
}

// A scene of nothing but bodies: the work of a blow counts in the balance of energy there, too.
TEST(ImpulseEvents, StrikeAMassThatNothingElseActsOn) {
  for (const std::string kind : {R"("particle": true)", R"("inertia": 0.3)"}) {
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
      "bodies": {"ball": {"mass": 2, "velocity": [1, 0], )" +
                                 kind + R"(}},
      "outputs": ["ball.y", "ball.vy", "energy.kinetic", "energy.balance", "energy.dissipated"],
      "analyses": [{"type": "dynamics", "at": [0.05, 0.15], "tolerance": 1e-11, )" +
                                 event(R"({"i": "ball", "value": [0, 6]})") + "}]}");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(run.last("ball.vy"), 3 - 1.5, 1e-12);
    EXPECT_NEAR(run.last("ball.y"), 3 * 0.05 - 5 * 0.15 * 0.15, 1e-12);
    EXPECT_NEAR(run.last("energy.kinetic"), 1 + 1.5 * 1.5, 1e-11);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-11);
    EXPECT_NEAR(run.last("energy.dissipated"), 0, 1e-11);
  }
}

// Off the centre of a free body; the value follows parameters.
TEST(ImpulseEvents, StrikeAFreeBodyOffItsCentre) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"blow": 3},
    "bodies": {"plate": {"mass": 2, "inertia": 0.5, "angle": "90 deg"}},
    "outputs": ["plate.vx", "plate.vy", "plate.omega"],
    "analyses": [{"type": "dynamics", "at": [0.2], "tolerance": 1e-11, )" +
                               event(R"({"i": ["plate", [0.4, 0]], "value": ["=blow", "1 N s"]})") + "}]}");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.last("plate.vx"), 1.5, 1e-12);
  EXPECT_NEAR(run.last("plate.vy"), 0.5, 1e-12);
  EXPECT_NEAR(run.last("plate.omega"), -3 * 0.4 / 0.5, 1e-12);
}

TEST(ImpulseEvents, WrongOnesAreNamed) {
  const auto error_of = [](const std::string& impulse) {
    return run_text(R"({"catena": 1, "bodies": {"plate": {"mass": 2, "inertia": 0.5}},
      "analyses": [{"type": "dynamics", "until": 1, )" +
                    event(impulse) + "}]}")
        .outcome.error_text;
  };
  EXPECT_NE(error_of(R"({"i": "plaet", "value": [1, 0]})").find("there is no body \"plaet\" to strike"),
            std::string::npos);
  EXPECT_NE(error_of(R"({"i": "plate.tip", "value": [1, 0]})").find("body \"plate\" has no point \"tip\""),
            std::string::npos);
  EXPECT_NE(error_of(R"({"i": "ground", "value": [1, 0]})").find("not on the ground"), std::string::npos);
  EXPECT_NE(error_of(R"({"value": [1, 0]})").find("an impulse needs \"i\""), std::string::npos);
  EXPECT_NE(error_of(R"({"i": "plate", "value": ["1 N", 0]})").find("\"value\" of an impulse"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
