// Motions of mechanisms with redundant constraints: against their equation in one angle, theta'' = -m g r cos(theta) /
// I.
#include "trials/trial.hpp"

namespace catena {
namespace {

using testing::at_instant;
using testing::run_text;
using testing::run_trial;
using testing::TextRun;

/// theta at t of a pendulum with theta'' = -pull cos(theta), by Runge-Kutta of order 4 in 20,000 steps a second.
double swung(double pull, double theta, double omega, double t) {
  const int steps = static_cast<int>(20'000 * t);
  const long double h = static_cast<long double>(t) / steps;
  long double x = theta, v = omega;
  const auto a = [&](long double angle) { return -pull * std::cos(angle); };
  for (int k = 0; k < steps; ++k) {
    const long double v1 = v, a1 = a(x), v2 = v + h / 2 * a1, a2 = a(x + h / 2 * v1), v3 = v + h / 2 * a2,
                      a3 = a(x + h / 2 * v2), v4 = v + h * a3, a4 = a(x + h * v3);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return static_cast<double>(x);
}

TEST(RedundantTrials, ThreeCranksAtDefaultSettings) {
  const TextRun run = run_trial("three_cranks_default");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  // Cranks of length 2 r with the bar at their ends.
  const double r = 0.5073735989453858, m[] = {0.1905695053686797, 0.8029783354784548, 2.270704952032686},
               J[] = {0.01635264023421048, 0.06890302732612541, 0.19484765459612385}, bar = 4.9278109070115805;
  double inertia = 4 * bar * r * r, moment = 2 * bar * r;
  for (int k = 0; k < 3; ++k) inertia += J[k] + m[k] * r * r, moment += m[k] * r;
  for (const double t : {0.5, 1.0, 1.5, 2.0}) {
    const double theta = swung(9.81 * moment / inertia, 0.7228974996996839, 0, t);
    EXPECT_NEAR(at_instant(run, "b1.angle", t), theta, 1e-7) << t;
    EXPECT_NEAR(at_instant(run, "b2.angle", t), theta, 1e-7) << t;
  }
  EXPECT_NEAR(at_instant(run, "b1.angle", 1), -3.038413, 1e-6);
  EXPECT_LT(std::abs(run.last("energy.balance")), 1e-6);
}

TEST(RedundantTrials, FourCranksThroughFlatPositionsAtATightTolerance) {
  const TextRun run = run_trial("four_cranks_tight");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  const double l = 0.55, cranks = 0.8 + 1.1 + 0.8 + 0.8, bar = 3;
  const double inertia = cranks * l * l / 3 + bar * l * l, moment = cranks * l / 2 + bar * l;
  const double start = std::acos(-1.0) / 2;
  for (const double t : {1.0, 4.0, 10.0}) {
    EXPECT_NEAR(at_instant(run, "a.angle", t), swung(9.81 * moment / inertia, start, -2.1, t), 1e-9) << t;
  }
}

TEST(RedundantTrials, AForceThatGrowsFromZeroMovesAPairAtRest) {
  const TextRun run = run_trial("redundant_pair_at_rest");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  const double start = run.first("b0.x");
  for (const double t : {0.5, 1.0}) {
    // 9 x'' = sin(2 t)
    EXPECT_NEAR(at_instant(run, "b0.x", t) - start, (t / 2 - std::sin(2 * t) / 4) / 9, 1e-8) << t;
    EXPECT_NEAR(at_instant(run, "b0.ax", t), std::sin(2 * t) / 9, 1e-8) << t;
  }
}

TEST(RedundantTrials, AHeldBodyStaysWhereItIsAndReactionsFollowItsLoad) {
  const TextRun run = run_trial("held_body_under_load");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  for (const double t : {0.25, 0.5, 0.75, 1.0}) {
    EXPECT_NEAR(at_instant(run, "b.x", t), 0, 1e-14);
    EXPECT_NEAR(at_instant(run, "b.angle", t), 0, 1e-14);
    EXPECT_NEAR(at_instant(run, "w.torque", t), -10 * std::sin(7 * t), 1e-12) << t;
    EXPECT_NEAR(at_instant(run, "w.fy", t), 9.81, 1e-12);
  }
}

constexpr const char* parallelogram = R"json({ "catena": 1, "gravity": [0, -9.81],
  "bodies": { "a": { "rod": { "from": [0, 0], "to": [0.6, 0.8] }, "mass": 1 },
              "b": { "rod": { "from": [2, 0], "to": [2.6, 0.8] }, "mass": 1 },
              "c": { "rod": { "from": [0.6, 0.8], "to": [2.6, 0.8] }, "mass": 1 } },
  "constraints": [ { "type": "revolute", "name": "A", "i": "ground", "j": "a.from" },
                   { "type": "revolute", "name": "B", "i": ["ground", [2, 0]], "j": "b.from" },
                   { "type": "revolute", "name": "C", "i": "a.to", "j": "c.from" },
                   { "type": "revolute", "name": "D", "i": "b.to", "j": "c.to" } ],
  "drivers": [ { "type": "absolute_angle", "name": "first", "i": "a",
                 "value": { "polynomial": ["=atan2(0.8, 0.6)", 1] } },
               { "type": "absolute_angle", "name": "second", "i": "b",
                 "value": { "polynomial": ["=atan2(0.8, 0.6)", 1, 0, 0, LAST] } } ],
  "analyses": [ { "type": "dynamics", "until": 1, "every": 0.1 } ],
  "outputs": [ "a.angle", "first.load", "second.load", "first.work", "second.work", "energy" ]
})json";

std::string with(std::string text, const std::string& value) { return text.replace(text.find("LAST"), 4, value); }

TEST(RedundantTrials, DriversThatAgreeShareTheirLoad) {
  const TextRun run = run_text(with(parallelogram, "0"));
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  // Rods of 1 m: the weight of two at half their length and of the coupler, against a rotation of 1 rad/s.
  for (const double t : {0.0, 0.5, 1.0}) {
    const double moment = 2 * 9.81 * std::cos(std::atan2(0.8, 0.6) + t);
    EXPECT_NEAR(at_instant(run, "first.load", t) + at_instant(run, "second.load", t), moment, 1e-8) << t;
  }
  EXPECT_LT(std::abs(run.last("energy.balance")), 1e-7);
}

TEST(RedundantTrials, DriversThatComeToContradictEachOtherAreNamed) {
  const TextRun run = run_text(with(parallelogram, "1e-3"));
  EXPECT_EQ(run.analysis().report.status, Status::inconsistent) << run.analysis().report.message;
  EXPECT_NE(run.analysis().report.message.find("\"second\""), std::string::npos) << run.analysis().report.message;
}

}  // namespace
}  // namespace catena
