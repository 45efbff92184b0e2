// Blocks on inclined guides of carts, whose friction presses the guide itself (Painleve): one cart of mass a that moves
// along x, one block of mass m on it along v = (c, s), which does not turn; the guide's point is h below its centroid.
//
//   X'' = (Q - f c) / (a + m s^2)      n = -m s X''      M = -(T + h f)      slip'' = (p + f) / m - c X''
//   f = -mu N,   N = |n| + 2 |M| / L   where it slips forwards
//
// Q: force on the cart, p: on the block along v, T: torque on the block, f: friction on the block, n, M: what the guide
// presses with. f + mu N has its least value at the bend n = 0, f = Q / c, with the numbers below: forces that fit end
// where that value passes zero, and the sum of slopes is positive on the branch which the motion follows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double a = 0.2, m = 1, h = 0.14, length = 0.2, mu = 0.5, s = 0.5, Q = -8;
const double c = std::sqrt(0.75);

/// `torque`: its value at the start, and its rate.
std::string guide(double p, std::pair<double, double> torque, double slip, const std::string& method) {
  return fmt::format(
      R"({{"catena": 1, "bodies": {{"cart": {{"mass": {}, "inertia": 1}}, "block": {{"mass": {}, "inertia": 0.1,
        "position": {}, "velocity": {}}}}},
      "constraints": [{{"type": "absolute_y", "i": "cart", "value": 0}}, {{"type": "absolute_angle", "i": "cart",
        "value": 0}}, {{"type": "translational", "name": "J", "i": "cart", "axis_i": {}, "j": ["block", {}],
        "axis_j": {}}}],
      "forces": [{{"type": "point_force", "i": "cart", "force": [{}, 0]}}, {{"type": "point_force", "i": "block",
        "force": {}}}, {{"type": "torque", "i": "block", "torque": {{"polynomial": {}}}}},
        {{"type": "friction", "name": "rub", "joint": "J", "mu": {}, "length": {}}}],
      "outputs": ["J.slide", "rub.friction"], "analyses": [{{"type": "dynamics", "until": 1, "every": 0.1,
        "method": "{}", "tolerance": 1e-9}}]}})",
      a, m, pair_of(-h * s, h * c), pair_of(slip * c, slip * s), pair_of(c, s), pair_of(h * s, -h * c), pair_of(c, s),
      Q, pair_of(p * c, p * s), pair_of(torque.first, torque.second), mu, length, method);
}

/// The friction before the bend, where n and the moment keep their signs.
double friction(double T) {
  const double inertia = a + m * s * s;
  return -mu * (-m * s * Q / inertia - 2 * T / length) / (1 + mu * (m * s * c / inertia - 2 * h / length));
}

TEST(PressedGuides, EndInconsistentWhereNoFrictionFits) {
  constexpr double rate = -1, push = 14, slip = 0.3;
  const double end = (1 - 2 * mu * h / length) * (Q / c) / (2 * mu / length * rate);
  ASSERT_NEAR(friction(rate * end), Q / c, 1e-12);
  // Of this f the slip's acceleration is linear in time.
  const auto acceleration = [&](double t) {
    const double f = friction(rate * t);
    return (push + f) / m - c * (Q - f * c) / (a + m * s * s);
  };
  const double jerk = acceleration(1) - acceleration(0);
  for (const std::string method : {"rk8", "rk5", "adams", "radau"}) {
    SCOPED_TRACE(method);
    const TextRun run = run_text(guide(push, {0, rate}, slip, method));
    const Report& report = run.analysis().report;
    EXPECT_EQ(report.status, Status::inconsistent) << report.message << run.outcome.error_text;
    EXPECT_NE(report.message.find("\"rub\""), std::string::npos) << report.message;
    EXPECT_NE(report.message.find("Painleve"), std::string::npos) << report.message;
    const std::size_t at = report.message.find("at t = ");
    ASSERT_NE(at, std::string::npos) << report.message;
    EXPECT_NEAR(std::stod(report.message.substr(at + 7)), end, 1e-6);
    const double t = run.last("t");
    ASSERT_GT(t, 0.35);
    EXPECT_NEAR(run.last("rub.friction"), friction(rate * t), 1e-7);
    EXPECT_NEAR(run.last("J.slide"), slip * t + acceleration(0) * t * t / 2 + jerk * t * t * t / 6, 1e-8);
  }
}

// Force and moment both press more where friction is larger, by more than it: what is found in turns moves away.
TEST(PressedGuides, SlideUnderFrictionThatIncreasesWithItself) {
  constexpr double T = 2, push = 14, slip = 0.3, inertia = a + m * s * s;
  ASSERT_GT(mu * (m * s * c / inertia + 2 * h / length), 1);
  const double f = -mu * (-m * s * Q / inertia + 2 * T / length) / (1 + mu * (m * s * c / inertia + 2 * h / length));
  ASSERT_LT(Q - f * c, 0);
  ASSERT_GT(T + h * f, 0);
  const double acceleration = (push + f) / m - c * (Q - f * c) / inertia;
  for (const std::string method : {"auto", "radau"}) {
    const TextRun run = run_text(guide(push, {T, 0}, slip, method));
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
    EXPECT_NEAR(run.first("rub.friction"), f, 1e-9);
    EXPECT_NEAR(run.last("J.slide"), slip + acceleration / 2, 1e-8);
  }
}

// At rest, pulled so hard that friction holds it only with the normal force that itself makes: it may slip as well.
TEST(PressedGuides, StickWhereTheyMayAndTellThatTheyMaySlip) {
  constexpr double push = 60;
  const double inertia = a + m * s * s, held = (c * Q / inertia - push / m) / (1 / m + c * c / inertia);
  const double normal = std::abs(m * s * (Q - held * c) / inertia) + 2 * std::abs(h * held) / length;
  ASSERT_LT(std::abs(held), mu * normal);
  const double free = friction(0);
  ASSERT_GT((push + free) / m - c * (Q - free * c) / inertia, 0);
  const TextRun run = run_text(guide(push, {0, 0}, 0, "auto"));
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
  EXPECT_NEAR(run.last("J.slide"), 0, 1e-9);
  EXPECT_NEAR(run.last("rub.friction"), held, 1e-9);
  std::string all;
  for (const std::string& warning : run.analysis().report.warnings) all += warning;
  EXPECT_NE(all.find("\"rub\" sticks; as well: \"rub\" slides"), std::string::npos) << all;
}

}  // namespace
}  // namespace catena::testing
