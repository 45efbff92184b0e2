// Friction of joints in inverse dynamics: loads of drivers in closed form, and those of dynamics.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// An arm of mass 2 whose centroid goes round its pin at the distance 1/2, phi = 0.3 + a t + b t^2: the pin's force does
// not depend on its friction, which is mu R |force| against the motion.
TEST(InverseFriction, OfAPinIsItsForce) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int n = 0; n < 20; ++n) {
    SCOPED_TRACE(n);
    const double a = 3 * number(engine), b = number(engine), mu = 0.3 + 0.2 * number(engine);
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
      "bodies": {{"arm": {{"mass": 2, "inertia": 0.1, "position": ["=cos(0.3)/2", "=sin(0.3)/2"], "angle": 0.3,
                          "points": {{"o": [-0.5, 0]}}}}}},
      "constraints": [{{"type": "revolute", "name": "pin", "i": "ground", "j": "arm.o"}}],
      "drivers": [{{"type": "absolute_angle", "name": "drive", "i": "arm", "value": {{"polynomial": [0.3, {}, {}]}}}}],
      "forces": [{{"type": "friction", "name": "rub", "joint": "pin", "mu": {}, "radius": 0.05}}],
      "outputs": ["drive.load", "rub.friction", "rub.slip", "pin.fx", "pin.fy", "energy.dissipated", "energy.balance"],
      "analyses": [{{"type": "inverse_dynamics", "until": 0.4, "every": 0.1}}]}})",
                                             a, b, mu));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const std::vector<double> t = run.column("t"), load = run.column("drive.load"),
                              friction = run.column("rub.friction");
    const std::vector<double> balance = run.column("energy.balance"), lost = run.column("energy.dissipated");
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double phi = 0.3 + (a + b * t[k]) * t[k], omega = a + 2 * b * t[k], alpha = 2 * b;
      const double ax = -(alpha * std::sin(phi) + omega * omega * std::cos(phi)) / 2;
      const double ay = (alpha * std::cos(phi) - omega * omega * std::sin(phi)) / 2;
      const double force = std::hypot(2 * ax, 2 * (ay + 9.81)), torque = mu * 0.05 * force * (omega > 0 ? 1 : -1);
      EXPECT_NEAR(friction[k], -torque, 1e-11);
      EXPECT_NEAR(load[k], (0.1 + 2 * 0.25) * alpha + 2 * 9.81 * std::cos(phi) / 2 + torque, 1e-10);
      EXPECT_NEAR(balance[k], 0, 1e-8);
      EXPECT_GE(lost[k], 0);
    }
  }
}

// A wheel on its centre that swings to and fro: its pin carries the weight, and what is lost is torque times way,
// though the torque turns round between the rows, at pi/8 and every pi/4 from there.
TEST(InverseFriction, IsSummedUpAcrossReversals) {
  for (const char* vs : {"", R"(, "vs": 5e-5)"}) {
    for (const char* rows : {R"("at": [0.5, 2])", R"("until": 2, "every": 0.3)"}) {
      SCOPED_TRACE(std::string(vs) + rows);
      const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
        "bodies": {{"wheel": {{"mass": 4, "inertia": 0.3}}}},
        "constraints": [{{"type": "revolute", "name": "pin", "i": "ground", "j": "wheel"}}],
        "drivers": [{{"type": "absolute_angle", "name": "drive", "i": "wheel",
                      "value": {{"harmonic": {{"amplitude": 1, "omega": 4}}}}}}],
        "forces": [{{"type": "friction", "joint": "pin", "mu": 0.2, "radius": 0.05{}}}],
        "outputs": ["energy.dissipated", "drive.work"], "analyses": [{{"type": "inverse_dynamics", {}}}]}})",
                                               vs, rows));
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      // Of tanh(v / vs), v = 0.05 omega, (vs/0.05)^2 pi^2/24 / 16 rad of the way are missing at each side of a
      // reversal.
      const double torque = 0.2 * 4 * 9.81 * 0.05, way = 5 + (1 - std::abs(std::sin(8.0)));
      EXPECT_NEAR(run.last("energy.dissipated"), torque * way, (*vs ? 1e-6 : 1e-8) * torque * way);
      EXPECT_NEAR(run.last("drive.work"), torque * way + 0.5 * 0.3 * (std::pow(4 * std::cos(8.0), 2) - 16),
                  (*vs ? 1e-6 : 1e-8) * torque * way);
    }
  }
}

// A block pushed at the height h over a guide of the length l: N = m g + 2 |F h|/l and F = m a + mu N, so that
// F (1 - 2 mu h/l) = m (a + mu g).
std::string pushed_block(double mu, double h, double speed) {
  return fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
    "bodies": {{"block": {{"mass": 3, "inertia": 1, "points": {{"handle": [0, {}]}}}}}},
    "constraints": [{{"type": "translational", "name": "guide", "i": "ground", "j": "block", "axis_i": [1, 0], "axis_j": [1, 0]}}],
    "drivers": [{{"type": "absolute_x", "name": "push", "i": "block.handle", "value": {{"polynomial": [0, {}, 0.5]}}}}],
    "forces": [{{"type": "friction", "joint": "guide", "mu": {}, "length": 0.4}}],
    "outputs": ["push.load", "guide.fy"],
    "analyses": [{{"type": "inverse_dynamics", "until": 0.4, "every": 0.1}}]}})",
                     h, speed, mu);
}

TEST(InverseFriction, OfAGuideIsFoundTogetherWithItsReaction) {
  for (const double mu : {0.1, 0.25, 0.4}) {
    for (const double h : {0.0, 0.1, 0.3}) {
      const TextRun run = run_text(pushed_block(mu, h, 1));
      ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
      for (const double load : run.column("push.load"))
        EXPECT_NEAR(load, 3 * (1 + mu * 9.81) / (1 - 2 * mu * h / 0.4), 1e-9) << mu << " " << h;
    }
  }
}

TEST(InverseFriction, TellsAGuideThatJams) {
  const TextRun run = run_text(pushed_block(0.6, 0.4, 1));  // 2 mu h/l = 1.2
  EXPECT_EQ(run.analysis().report.status, Status::inconsistent);
  EXPECT_NE(run.analysis().report.message.find("friction"), std::string::npos) << run.analysis().report.message;
}

TEST(InverseFriction, IsNotKnownAtRest) {
  const TextRun run = run_text(pushed_block(0.2, 0, 0));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.column("push.load")[0], 3, 1e-12);
  EXPECT_NEAR(run.column("push.load")[1], 3 * (1 + 0.2 * 9.81), 1e-10);
  ASSERT_EQ(run.analysis().report.warnings.size(), 1u);
  EXPECT_NE(run.analysis().report.warnings[0].find("rests at t = 0 s"), std::string::npos);
}

// A crank-rocker of random lengths with four pins that rub, exact and smoothed: dynamics, which integrates the motion
// and takes another matrix, has the same loads.
TEST(InverseFriction, AgreesWithDynamics) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> number(0, 1);
  for (int n = 0; n < 8; ++n) {
    SCOPED_TRACE(n);
    const double x = 2 + number(engine), y = 1.5 + number(engine), omega = (n % 2 == 0 ? 1 : -1) * (1 + number(engine));
    std::string frictions;
    for (const char* joint : {"A", "B", "C", "D"}) {
      const double mu = 0.1 + 0.3 * number(engine), radius = 0.02 + 0.05 * number(engine);
      frictions +=
          fmt::format(R"({}{{"type": "friction", "name": "f{}", "joint": "{}", "mu": {}, "radius": {}{}}})",
                      frictions.empty() ? "" : ", ", joint, joint, mu, radius, n % 3 == 2 ? R"(, "vs": 0.05)" : "");
    }
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
      "bodies": {{"crank": {{"mass": 1, "rod": {{"from": [0, 0], "to": [0.5, 0.5]}}, "angular_velocity": {2}}},
                 "coupler": {{"mass": 3, "rod": {{"from": [0.5, 0.5], "to": [{0}, {1}]}}}},
                 "rocker": {{"mass": 2, "rod": {{"from": [2.5, 0], "to": [{0}, {1}]}}}}}},
      "constraints": [{{"type": "revolute", "name": "A", "i": "ground", "j": "crank.from"}},
                      {{"type": "revolute", "name": "B", "i": "crank.to", "j": "coupler.from"}},
                      {{"type": "revolute", "name": "C", "i": "coupler.to", "j": "rocker.to"}},
                      {{"type": "revolute", "name": "D", "i": ["ground", [2.5, 0]], "j": "rocker.from"}}],
      "drivers": [{{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {{"polynomial": ["=pi/4", {2}]}}}}],
      "forces": [{3}],
      "outputs": ["drive.load", "A.fx", "C.fy", "fA.friction", "fB.friction", "fC.friction", "fC.slip", "fD.friction"],
      "analyses": [{{"type": "inverse_dynamics", "at": [0.05, 0.2]}},
                   {{"type": "dynamics", "from": "initial", "at": [0.05, 0.2], "tolerance": 1e-11}}]}})",
                                             x, y, omega, frictions));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis(0).report.message << run.analysis(1).report.message;
    for (const char* name :
         {"drive.load", "A.fx", "C.fy", "fA.friction", "fB.friction", "fC.friction", "fC.slip", "fD.friction"}) {
      const std::vector<double> inverse = run.column(name, 0), dynamics = run.column(name, 1);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(inverse[k], dynamics[k], 1e-6) << name;
        EXPECT_NE(inverse[k], 0) << name;
      }
    }
  }
}

/// The integral of |weight - pull cos(nu t)| from zero to t.
double pressed(double weight, double pull, double nu, double t) {
  const auto sum = [&](double at) { return weight * at - pull * std::sin(nu * at) / nu; };
  double total = 0, from = 0;
  for (int zero = 0; from < t; ++zero) {
    const double turn = std::acos(weight / pull), turns = 2 * std::acos(-1.0) * (zero / 2);
    const double to = std::min(t, (zero % 2 == 0 ? turns + turn : turns + 2 * std::acos(-1.0) - turn) / nu);
    total += std::abs(sum(to) - sum(from));
    from = to;
  }
  return total;
}

// A block goes along its guide, and an arm round its pin, at constant speed, while a force lifts them now and then: N
// is the size of what bends where they lose and meet their support, and the drivers give what friction takes.
TEST(InverseFriction, WorkWhereWhatPressesTurnsRound) {
  std::mt19937 engine(5);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(engine);
  };
  for (int n = 0; n < 12; ++n) {
    const double mass = between(1, 3), pull = mass * 9.81 * between(1.05, 4), nu = between(2, 12),
                 mu = between(0.1, 0.6);
    const double speed = between(0.5, 3), smooth = between(0.05, 0.5), every = n % 3 == 0 ? 2 : between(0.05, 0.5);
    SCOPED_TRACE(n);
    const bool slides = n % 2 == 0;
    const std::string guided = R"("constraints": [{"type": "translational", "name": "J", "i": ["ground", [0, 0]],
        "j": ["b", [0, 0]], "axis_i": [1, 0], "axis_j": [1, 0]}],
      "drivers": [{"type": "displacement", "name": "D", "i": ["ground", [0, 0]], "j": ["b", [0, 0]], "axis_i": [1, 0],)";
    const std::string pinned = R"("constraints": [{"type": "revolute", "name": "J", "i": "ground", "j": ["b", [0, 0]]}],
      "drivers": [{"type": "absolute_angle", "name": "D", "i": "b",)";
    const TextRun run = run_text(fmt::format(
        R"({{"catena": 1, "gravity": [0, -9.81],
      "bodies": {{"b": {{"mass": {0}, "inertia": 0.2, "position": [0, 0], "points": {{"o": [0, 0], "r": [0.5, 0]}}}}}},
      {1} "value": {{"polynomial": [0, {2}]}}}}],
      "forces": [{{"type": "friction", "name": "rub", "joint": "J", "mu": {3}, {4}}},
                 {{"type": "point_force", "i": "b.o", "force": [0, {{"harmonic": {{"amplitude": {5}, "omega": {6},
                   "phase": 1.5707963267948966}}}}]}}],
      "outputs": ["D.work", "energy.dissipated"], "analyses": [{{"type": "inverse_dynamics", "until": 2, "every": {7}}}]}})",
        mass, slides ? guided : pinned, speed, mu, slides ? fmt::format(R"("vs": {})", smooth) : R"("radius": 0.1)",
        pull, nu, every));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const double power = mu * speed * (slides ? std::tanh(speed / smooth) : 0.1);
    const std::vector<double> t = run.column("t"), work = run.column("D.work"), lost = run.column("energy.dissipated");
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double right = power * pressed(mass * 9.81, pull, nu, t[k]);
      EXPECT_NEAR(work[k], right, 2e-9 * (1 + right)) << t[k];
      EXPECT_NEAR(lost[k], right, 2e-9 * (1 + right)) << t[k];
    }
  }
}

// An unbalanced wheel on a pin that rubs: its force m e w^2 turns round the pin and never comes near zero.
TEST(InverseFriction, APinsForceMayTurnRoundIt) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 0.2, "position": [0.3, 0]}},
    "constraints": [{"type": "revolute", "name": "J", "i": "ground", "j": "b", "at": [0, 0]}],
    "drivers": [{"type": "absolute_angle", "name": "D", "i": "b", "value": {"polynomial": [0, 5]}}],
    "forces": [{"type": "friction", "name": "rub", "joint": "J", "mu": 0.3, "radius": 0.1}],
    "outputs": ["D.work"], "analyses": [{"type": "inverse_dynamics", "until": 10, "every": 1}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(run.analysis().report.warnings.empty()) << run.analysis().report.warnings.front();
  EXPECT_NEAR(run.last("D.work"), 0.3 * (2 * 0.3 * 25) * 0.1 * 5 * 10, 1e-11);
}

// Force and moment of a guide turn at different instants, at which the other one goes on to rub.
TEST(InverseFriction, ForceAndMomentOfAGuideTurnOneByOne) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"b": {"mass": 2, "inertia": 0.2, "position": [0, 0], "points": {"o": [0, 0]}}},
    "constraints": [{"type": "translational", "name": "J", "i": ["ground", [0, 0]], "j": ["b", [0, 0]],
                     "axis_i": [1, 0], "axis_j": [1, 0]}],
    "drivers": [{"type": "displacement", "name": "D", "i": ["ground", [0, 0]], "j": ["b", [0, 0]], "axis_i": [1, 0],
                 "value": {"polynomial": [0, 2]}}],
    "forces": [{"type": "friction", "name": "rub", "joint": "J", "mu": 0.3, "length": 0.2},
               {"type": "point_force", "i": "b.o", "force": [0, {"harmonic": {"amplitude": 40, "omega": 7}}]},
               {"type": "torque", "i": "b", "torque": {"harmonic": {"amplitude": 3, "omega": 3}}}],
    "outputs": ["D.work"], "analyses": [{"type": "inverse_dynamics", "until": 2, "every": 2}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(run.analysis().report.warnings.empty()) << run.analysis().report.warnings.front();
  // mu v times the integrals of |m g - F sin 7 t| and |T sin 3 t| 2 / length, over parts without a change of sign.
  const auto integral = [](double mean, double amplitude, double omega, double from, double to) {
    return mean * (to - from) + amplitude * (std::cos(omega * to) - std::cos(omega * from)) / omega;
  };
  const auto of_size = [&](double mean, double amplitude, double omega) {
    std::vector<double> ends = {0};
    const double arc = std::asin(mean / amplitude), pi = std::acos(-1.0);
    for (int turn = 0; turn < 3; ++turn) {
      for (const double angle : {arc + 2 * pi * turn, pi - arc + 2 * pi * turn}) {
        if (angle > 0 && angle < 2 * omega) ends.push_back(angle / omega);
      }
    }
    ends.push_back(2);
    double sum = 0;
    for (std::size_t k = 1; k < ends.size(); ++k)
      sum += std::abs(integral(mean, amplitude, omega, ends[k - 1], ends[k]));
    return sum;
  };
  const double right = 0.3 * 2 * (of_size(2 * 9.81, 40, 7) + of_size(0, 3, 3) / 0.1);
  EXPECT_NEAR(run.last("D.work"), right, 1e-8);
}

}  // namespace
}  // namespace catena::testing
