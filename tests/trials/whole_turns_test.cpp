// Angles are continuous: in every method, at releases and at engagements.
#include <numbers>

#include "trials/trial.hpp"

namespace catena::testing {
namespace {

constexpr double turn = 2 * std::numbers::pi;

/// No step between rows is larger than `most`, rad.
void expect_continuous(const TextRun& run, const std::string& column, double most) {
  const std::vector<double> angle = run.column(column);
  for (std::size_t k = 1; k < angle.size(); ++k) EXPECT_LT(std::abs(angle[k] - angle[k - 1]), most) << column << k;
}

TEST(WholeTurns, AdamsAcrossFlatPositions) {
  const TextRun run = run_trial("three_cranks_adams");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  EXPECT_NEAR(at_instant(run, "b1.angle", 0.9), 5.0934, 1e-4);
  for (const char* column : {"b1.angle", "b2.angle", "b3.angle"}) expect_continuous(run, column, 1);
}

TEST(WholeTurns, AReleasedAngleKeepsThem) {
  const TextRun run = run_trial("release_beyond_pi");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  // 4 cos(sqrt(10) (t - 0.5))
  EXPECT_NEAR(at_instant(run, "a.angle", 0.75), 4 * std::cos(std::sqrt(10.0) * 0.25), 1e-7);
  for (const double balance : run.column("energy.balance")) EXPECT_NEAR(balance, 0, 1e-7);
  for (const double energy : run.column("energy.total")) EXPECT_NEAR(energy, 8, 1e-7);
}

/// A flywheel a of 3 kg m^2 turns at 5 rad/s, b of 1 kg m^2 stands; at `turns` turns of a they are tied.
TextRun run_clutch(const std::string& clutch, int turns) {
  return run_text(R"({"catena": 1,
    "bodies": {"a": {"mass": 1, "inertia": 3, "angular_velocity": 5}, "b": {"mass": 1, "inertia": 1}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a"}, {"type": "revolute", "i": "ground", "j": "b"},
                    {"name": "clutch", "i": "a", "j": "b", )" +
                  clutch + R"(}],
    "outputs": ["a.angle", "b.angle", "b.omega", "energy"],
    "analyses": [{"type": "dynamics", "until": 9, "every": 0.25, "tolerance": 1e-10,
      "events": [{"name": "meet", "when": "a.angle", "value": "=2*pi*)" +
                  std::to_string(turns) + R"(", "action": "engage", "element": "clutch"},
                 {"name": "part", "when": "t", "value": 8, "action": "release", "element": "clutch"}]}]})");
}

TEST(WholeTurns, AClutchClosesOnThePoseItFinds) {
  for (const std::string clutch : {R"("type": "relative_angle", "value": 0)", R"("type": "weld")"}) {
    for (const int turns : {1, 2, 5}) {
      const TextRun run = run_clutch(clutch, turns);
      ASSERT_EQ(run.outcome.exit_code, 0) << clutch << run.outcome.error_text << run.analysis().report.message;
      const double meet = turns * turn / 5;
      EXPECT_NEAR(run.last("a.angle"), turns * turn + 3.75 * (9 - meet), 1e-8) << clutch << turns;
      EXPECT_NEAR(run.last("b.angle"), 3.75 * (9 - meet), 1e-8) << clutch << turns;
      EXPECT_NEAR(run.last("b.omega"), 3.75, 1e-8);
      for (const double balance : run.column("energy.balance")) EXPECT_NEAR(balance, 0, 1e-7);
    }
  }
}

// A motor that starts at an event, its angle a function of time: the body has turned three times before.
TEST(WholeTurns, ADriverIsEngagedAfterTurns) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"a": {"mass": 1, "inertia": 3, "angular_velocity": 6.283185307179586}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a"}],
    "drivers": [{"type": "absolute_angle", "name": "motor", "i": "a",
                 "value": {"polynomial": [-9, 0, 1]}}],
    "outputs": ["a.angle", "a.omega"],
    "analyses": [{"type": "dynamics", "until": 4, "every": 0.25, "tolerance": 1e-10,
      "events": [{"when": "t", "value": 3, "action": "engage", "element": "motor"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(at_instant(run, "a.angle", 2.75), 2.75 * turn, 1e-8);
  EXPECT_NEAR(run.last("a.angle"), 3 * turn + 7, 1e-8);
  EXPECT_NEAR(run.last("a.omega"), 8, 1e-8);
}

// A pinion that ran free for two turns comes into mesh with a rack that stands still.
TEST(WholeTurns, ARackMeetsATurnedPinion) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"rack": {"mass": 4, "inertia": 1, "position": [0, 0.5]},
               "wheel": {"mass": 1, "inertia": 0.5, "angular_velocity": 6.283185307179586}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "wheel"},
                    {"type": "translational", "i": ["ground", [0, 0.5]], "j": "rack", "axis_i": [1, 0]},
                    {"type": "rack_pinion", "name": "mesh", "i": "rack", "j": "wheel", "axis_i": [1, 0],
                     "radius": 0.5, "side": -1}],
    "outputs": ["wheel.angle", "wheel.omega", "rack.x", "energy"],
    "analyses": [{"type": "dynamics", "until": 3, "every": 0.25, "tolerance": 1e-10,
      "events": [{"when": "t", "value": 2, "action": "engage", "element": "mesh"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  // The rack's mass counts as 4 * 0.5^2 = 1 kg m^2.
  EXPECT_NEAR(run.last("wheel.omega"), turn / 3, 1e-8);
  EXPECT_NEAR(run.last("wheel.angle"), 2 * turn + turn / 3, 1e-8);
  EXPECT_NEAR(run.last("rack.x"), -0.5 * turn / 3, 1e-8);
}

}  // namespace
}  // namespace catena::testing
