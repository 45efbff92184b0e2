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
#include <vector>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double a = 0.2, m = 1, h = 0.14, length = 0.2, mu = 0.5, s = 0.5, Q = -8;
const double c = std::sqrt(0.75);

/// `torque` grows with time by this rate.
std::string guide(double p, double torque, double slip, const std::string& method) {
  return fmt::format(
      R"({{"catena": 1, "bodies": {{"cart": {{"mass": {}, "inertia": 1}}, "block": {{"mass": {}, "inertia": 0.1,
        "position": {}, "velocity": {}}}}},
      "constraints": [{{"type": "absolute_y", "i": "cart", "value": 0}}, {{"type": "absolute_angle", "i": "cart",
        "value": 0}}, {{"type": "translational", "name": "J", "i": "cart", "axis_i": {}, "j": ["block", {}],
        "axis_j": {}}}],
      "forces": [{{"type": "point_force", "i": "cart", "force": [{}, 0]}}, {{"type": "point_force", "i": "block",
        "force": {}}}, {{"type": "torque", "i": "block", "torque": {{"polynomial": [0, {}]}}}},
        {{"type": "friction", "name": "rub", "joint": "J", "mu": {}, "length": {}}}],
      "outputs": ["J.slide", "rub.friction"], "analyses": [{{"type": "dynamics", "until": 1, "every": 0.1,
        "method": "{}", "tolerance": 1e-9}}]}})",
      a, m, pair_of(-h * s, h * c), pair_of(slip * c, slip * s), pair_of(c, s), pair_of(h * s, -h * c), pair_of(c, s),
      Q, pair_of(p * c, p * s), torque, mu, length, method);
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
    const TextRun run = run_text(guide(push, rate, slip, method));
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

// At rest, pulled so hard that friction holds it only with the normal force that itself makes: it may slip as well.
TEST(PressedGuides, StickWhereTheyMayAndTellThatTheyMaySlip) {
  constexpr double push = 60;
  const double inertia = a + m * s * s, held = (c * Q / inertia - push / m) / (1 / m + c * c / inertia);
  const double normal = std::abs(m * s * (Q - held * c) / inertia) + 2 * std::abs(h * held) / length;
  ASSERT_LT(std::abs(held), mu * normal);
  const double free = friction(0);
  ASSERT_GT((push + free) / m - c * (Q - free * c) / inertia, 0);
  const TextRun run = run_text(guide(push, 0, 0, "auto"));
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
  EXPECT_NEAR(run.last("J.slide"), 0, 1e-9);
  EXPECT_NEAR(run.last("rub.friction"), held, 1e-9);
  std::string all;
  for (const std::string& warning : run.analysis().report.warnings) all += warning;
  EXPECT_NE(all.find("\"rub\" sticks; as well: \"rub\" slides"), std::string::npos) << all;
}

// A slide on the ground whose centroid is e above the guide, pushed at the height b, in motion: m a = F - mu N with
// N = |F_n| + 2 |b F - e m a| / L. Friction that makes up to 0.99 of itself has one solution; beyond 1 two or none.
TEST(PressedGuides, FrictionThatNearlyMakesItself) {
  constexpr double mass = 1, e = 0.25, b = 0.28, guide_length = 0.3, along = -18, across = -5;
  for (const double part : {0.5, 0.9, 0.97, 0.99, 1.05}) {
    SCOPED_TRACE(part);
    const double rubs = part * guide_length / (2 * e);
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "bodies": {{"s": {{"mass": {}, "inertia": 0.1,
      "centroid": [0, {}], "position": [0, 0], "velocity": [0.6, 0]}}}},
      "constraints": [{{"type": "translational", "name": "G", "i": "ground", "j": "s", "axis_i": [1, 0],
        "axis_j": [1, 0]}}],
      "forces": [{{"type": "point_force", "i": ["s", [0, {}]], "force": [{}, {}]}},
                 {{"type": "friction", "name": "R", "joint": "G", "mu": {:.17g}, "length": {}}}],
      "outputs": ["s.ax"], "analyses": [{{"type": "dynamics", "until": 1e-4, "every": 1e-4}}]}})",
                                             mass, e, b, along, across, rubs, guide_length));
    std::vector<double> fits;
    for (const double side : {1.0, -1.0}) {  // of the moment
      const double arm = 2 * rubs * side / guide_length;
      const double a_fits = (along - rubs * std::abs(across) - arm * b * along) / (mass * (1 - arm * e));
      if (side * (b * along - e * mass * a_fits) >= 0) fits.push_back(a_fits);
    }
    ASSERT_EQ(fits.size() == 1, part < 1);
    if (part < 1) {
      ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message << run.outcome.error_text;
      EXPECT_NEAR(run.first("s.ax"), fits[0], 1e-9 * std::abs(fits[0]));
    } else {
      EXPECT_EQ(run.analysis().report.status, Status::inconsistent);
      EXPECT_NE(run.analysis().report.message.find("Painleve"), std::string::npos) << run.analysis().report.message;
    }
  }
}

}  // namespace
}  // namespace catena::testing
