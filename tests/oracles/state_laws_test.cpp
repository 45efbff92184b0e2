// Laws of state in motion, driven motion and at rest, against closed forms and integrations in the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "oracles/state_law_references.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

using std::numbers::pi;

/// A mass that slides along x, pulled by an expression.
std::string oscillator(const std::string& analyses) {
  return law_scene(
      R"--("parameters": {"k": 50, "m": 2},
    "bodies": {"mass": {"mass": "m", "particle": true, "position": [0.3, 0], "velocity": [0.4, 0]}},
    "forces": [{"type": "point_force", "name": "pull", "i": "mass", "force": ["=-k*mass.x", 0]}])--",
      R"--("mass.x", "mass.vx", "pull.fx", "pull.power", "energy.potential", "energy.total", "energy.balance")--",
      analyses);
}

TEST(StateLaws, AnExpressionActsAsASpringButHasNoEnergy) {
  const TextRun run =
      run_text(oscillator(R"--({"type": "dynamics", "until": 10, "every": 0.1, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> t = run.column("t"), x = run.column("mass.x"), v = run.column("mass.vx"),
                            total = run.column("energy.total"), power = run.column("pull.power");
  ASSERT_EQ(t.size(), 101u);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(x[k], 0.3 * std::cos(5 * t[k]) + 0.08 * std::sin(5 * t[k]), 1e-9);
    EXPECT_NEAR(power[k], -50 * x[k] * v[k], 1e-12);
    EXPECT_NEAR(run.column("pull.fx")[k], -50 * x[k], 1e-13);
    EXPECT_EQ(run.column("energy.potential")[k], 0);
    // What a spring would store is missing from the total, and the work of the law says so.
    EXPECT_NEAR(total[k], 2 * v[k] * v[k] / 2, 1e-13);
    EXPECT_NEAR(run.column("energy.balance")[k], 0, 1e-9);
  }
}

TEST(StateLaws, MotionsHaveDerivatives) {
  const TextRun run = run_text(oscillator(R"--({"type": "sensitivity", "parameters": ["k", "m"], "verify": true,
    "of": {"type": "dynamics", "at": [1.7], "tolerance": 1e-11, "measures": {"x": {"final": "mass.x"}}}})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double t = 1.7;
  // x = 0.3 cos wt + (0.4 / w) sin wt with w^2 = k / m
  const double by_w = -0.3 * t * std::sin(5 * t) + 0.4 / 5 * t * std::cos(5 * t) - 0.4 / 25 * std::sin(5 * t);
  EXPECT_NEAR(run.last("d(mass.x)/d(k)"), by_w / (2 * 5 * 2), 1e-9);
  EXPECT_NEAR(run.last("d(mass.x)/d(m)"), -by_w * 5 / (2 * 2), 1e-8);
  EXPECT_LT(field<double>(run, "deviation"), 1e-6);
}

TEST(StateLaws, DragEndsInTheTerminalVelocity) {
  const TextRun run = run_text(law_scene(R"--("gravity": [0, -9.81], "parameters": {"c": 0.7},
    "bodies": {"ball": {"mass": 3, "particle": true}},
    "forces": [{"type": "point_force", "name": "drag", "i": "ball", "force": [0, "=-c*ball.vy*abs(ball.vy)"]}])--",
                                         R"--("ball.y", "ball.vy", "energy.balance", "energy.dissipated")--",
                                         R"--({"type": "dynamics", "until": 5, "every": 0.05, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double terminal = std::sqrt(3 * 9.81 / 0.7);
  const std::vector<double> t = run.column("t");
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(run.column("ball.vy")[k], -terminal * std::tanh(9.81 * t[k] / terminal), 1e-9);
    EXPECT_NEAR(run.column("ball.y")[k], -terminal * terminal / 9.81 * std::log(std::cosh(9.81 * t[k] / terminal)),
                1e-9);
    EXPECT_NEAR(run.column("energy.balance")[k], 0, 1e-8);
  }
}

TEST(StateLaws, AMotorCurveRunsUpExponentially) {
  const TextRun run =
      run_text(law_scene(R"--("parameters": {"stall": 12, "free": 150},
    "bodies": {"rotor": {"mass": 1, "inertia": 0.02}},
    "constraints": [{"type": "revolute", "name": "bearing", "i": "ground", "j": "rotor"}],
    "forces": [{"type": "torque", "name": "motor", "i": "rotor", "torque": "=stall*(1 - bearing.omega/free)"}])--",
                         R"--("rotor.omega", "rotor.angle", "motor.torque", "motor.power", "energy.balance")--",
                         R"--({"type": "dynamics", "until": 1, "every": 0.02, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> t = run.column("t");
  const double rate = 12 / (150 * 0.02);
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double omega = 150 * (1 - std::exp(-rate * t[k]));
    EXPECT_NEAR(run.column("rotor.omega")[k], omega, 1e-8);
    EXPECT_NEAR(run.column("rotor.angle")[k], 150 * t[k] - omega / rate, 1e-8);
    EXPECT_NEAR(run.column("motor.power")[k], 12 * std::exp(-rate * t[k]) * omega, 1e-6);
    EXPECT_NEAR(run.column("energy.balance")[k], 0, 1e-7);
  }
}

/// A rod of 1 m under gravity, hinged at its end, with a controller towards 0.5 rad.
std::string controlled(const std::string& analyses) {
  return law_scene(R"--("gravity": [0, -9.81], "parameters": {"kp": 60, "kd": 4},
    "bodies": {"arm": {"mass": 3, "rod": {"from": [0, 0], "to": [1, 0]}}},
    "constraints": [{"type": "revolute", "name": "hinge", "i": "ground", "j": "arm.from"}],
    "forces": [{"type": "torque", "name": "motor", "i": "arm", "torque": "=-kp*(arm.angle - 0.5) - kd*arm.omega"}])--",
                   R"--("arm.angle", "arm.omega", "motor.torque", "hinge.fx", "hinge.fy")--", analyses);
}

TEST(StateLaws, APendulumIsControlledToASetPoint) {
  const TextRun run = run_text(controlled(R"--({"type": "dynamics", "until": 2, "every": 2, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const auto slope = [](double, const ReferenceState& y) {
    const double torque = -60 * (y[0] - 0.5) - 4 * y[1] - 3 * 9.81 * 0.5 * std::cos(y[0]);
    return ReferenceState{y[1], torque / (3.0 / 3)};
  };
  const ReferenceState end = integrate(slope, {0, 0}, 2, 20000);
  EXPECT_NEAR(run.last("arm.angle"), end[0], 1e-9);
  EXPECT_NEAR(run.last("arm.omega"), end[1], 1e-9);
}

/// Where the controller holds the arm.
double held_angle() {
  double angle = 0.3;
  for (int k = 0; k < 50; ++k)
    angle -= (60 * (angle - 0.5) + 14.715 * std::cos(angle)) / (60 - 14.715 * std::sin(angle));
  return angle;
}

TEST(StateLaws, EquilibriumBalancesThemAndJudgesByTheirStiffness) {
  const TextRun run = run_text(controlled(R"--({"type": "equilibrium"})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("arm.angle"), held_angle(), 1e-10);
  EXPECT_NEAR(run.last("motor.torque"), 14.715 * std::cos(held_angle()), 1e-8);
  EXPECT_NEAR(run.last("hinge.fy"), 3 * 9.81, 1e-9);
  EXPECT_TRUE(field<bool>(run, "stable"));
  for (const NamedField& f : run.analysis().fields) EXPECT_NE(f.name, "energy");
}

TEST(StateLaws, EquilibriaHaveDerivatives) {
  const TextRun run = run_text(controlled(
      R"--({"type": "sensitivity", "parameters": ["kp", "kd"], "of": {"type": "equilibrium",
          "measures": {"angle": {"final": "arm.angle"}}}})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double angle = held_angle();
  EXPECT_NEAR(run.last("d(arm.angle)/d(kp)"), -(angle - 0.5) / (60 - 14.715 * std::sin(angle)), 1e-10);
  EXPECT_NEAR(run.last("d(arm.angle)/d(kd)"), 0, 1e-14);
}

// The arm's inertia about its hinge is 1 kg m^2: omega2 is the controller's stiffness less that of the weight.
TEST(StateLaws, StabilityAnalysesTakeTheirStiffness) {
  const TextRun run = run_text(controlled(R"--({"type": "equilibrium"}, {"type": "modes"},
      {"type": "buckling", "parameter": "kp"}, {"type": "path", "parameter": "kp", "to": 70})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const double weight = 14.715 * std::sin(held_angle());
  EXPECT_NEAR(run.last("omega2", 1), 60 - weight, 1e-9);
  EXPECT_NEAR(run.last("kp", 2), weight, 1e-9);
  const std::vector<double> kp = run.column("kp", 3), angle = run.column("arm.angle", 3);
  ASSERT_GT(kp.size(), 5u);
  for (std::size_t k = 0; k < kp.size(); ++k)
    EXPECT_NEAR(kp[k] * (angle[k] - 0.5) + 14.715 * std::cos(angle[k]), 0, 1e-9);
}

// A driven arm: the load of its driver is what the controller, gravity and inertia leave to it.
TEST(StateLaws, CountInTheLoadsOfDrivers) {
  const TextRun run = run_text(law_scene(R"--("gravity": [0, -9.81], "parameters": {"kp": 60, "kd": 4},
    "bodies": {"arm": {"mass": 3, "rod": {"from": [0, 0], "to": [1, 0]}}},
    "constraints": [{"type": "revolute", "name": "hinge", "i": "ground", "j": "arm.from"}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "arm",
                 "value": {"harmonic": {"amplitude": 0.4, "omega": 3}}}],
    "forces": [{"type": "torque", "name": "motor", "i": "arm", "torque": "=-kp*(arm.angle - 0.5) - kd*arm.omega"}])--",
                                         R"--("drive.load", "arm.angle", "arm.omega", "arm.alpha", "motor.torque")--",
                                         R"--({"type": "inverse_dynamics", "until": 2, "every": 0.1},
    {"type": "sensitivity", "from": "initial", "parameters": ["kp", "kd"],
     "of": {"type": "inverse_dynamics", "at": [0.7], "measures": {"load": {"final": "drive.load"}}}})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> t = run.column("t");
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double angle = 0.4 * std::sin(3 * t[k]), omega = 1.2 * std::cos(3 * t[k]), alpha = -9 * angle;
    const double law = -60 * (angle - 0.5) - 4 * omega;
    EXPECT_NEAR(run.column("motor.torque")[k], law, 1e-11);
    EXPECT_NEAR(run.column("drive.load")[k], alpha + 14.715 * std::cos(angle) - law, 1e-10);
  }
  EXPECT_NEAR(run.last("d(drive.load)/d(kp)", 1), 0.4 * std::sin(2.1) - 0.5, 1e-12);
  EXPECT_NEAR(run.last("d(drive.load)/d(kd)", 1), 1.2 * std::cos(2.1), 1e-12);
}

// Gas pressure over the crank's angle in a slider-crank that turns at constant speed: over a cycle the driver does the
// work that the gas does not, the integral of the force over the piston's way.
TEST(StateLaws, GasPressureDoesTheWorkOfItsDiagram) {
  const std::vector<double> x{0, 0.7, 1.5, 2.4, pi, 4, 5.2, 2 * pi}, y{900, 700, 300, 120, 80, 60, 150, 900};
  std::string points;
  for (std::size_t k = 0; k < x.size(); ++k) points += (k > 0 ? "," : "") + pair_of(x[k], y[k]);
  const TextRun run = run_text(
      law_scene(R"--("tables": {"gas": {"points": [)--" + points + R"--(], "end": "periodic"}},
    "bodies": {"crank": {"mass": 1, "inertia": 0.1, "points": {"pin": [0.04, 0]}},
               "rod": {"mass": 0.4, "rod": {"from": [0.04, 0], "to": [0.18, 0]}},
               "piston": {"mass": 0.5, "particle": true, "position": [0.18, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "crank"},
                    {"type": "revolute", "i": "crank.pin", "j": "rod.from"},
                    {"type": "revolute", "i": "rod.to", "j": "piston"}, {"type": "absolute_y", "i": "piston"}],
    "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, 20]}}],
    "forces": [{"type": "point_force", "name": "gas force", "i": "piston", "force": ["=-3*gas(crank.angle)", 0]
}])--",
                R"--("drive.work", "piston.x", "gas force.fx", "energy.balance")--",
                R"--({"type": "inverse_dynamics", "until": )--" + text_of(2 * pi / 20) + R"--(, "every": 0.01})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const ReferenceSpline gas(x, y, "periodic");
  // Gauss quadrature of three points in small intervals that begin and end at knots.
  double work = 0;
  constexpr int parts = 400;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    for (int n = 0; n < parts; ++n) {
      const double h = (x[k + 1] - x[k]) / parts, middle = x[k] + (n + 0.5) * h;
      for (const auto& [place, weight] :
           {std::pair(-std::sqrt(0.6), 5.0 / 9), std::pair(0.0, 8.0 / 9), std::pair(std::sqrt(0.6), 5.0 / 9)}) {
        const double a = middle + place * h / 2, root = std::sqrt(0.14 * 0.14 - 0.0016 * std::sin(a) * std::sin(a));
        const double way = -0.04 * std::sin(a) - 0.0016 * std::sin(a) * std::cos(a) / root;
        work += weight * h / 2 * -3 * gas(a) * way;
      }
    }
  }
  EXPECT_GT(work, 1);
  EXPECT_NEAR(run.last("drive.work"), -work, 1e-8 * work);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8 * work);
  EXPECT_NEAR(run.column("gas force.fx")[7], -3 * gas(20 * 0.07), 1e-10);
}

// Laws between bodies that nothing else ties, of very different pace: they may not be integrated apart.
TEST(StateLaws, TieBodies) {
  const TextRun run =
      run_text(law_scene(R"--("bodies": {
      "slow": {"mass": 100, "particle": true, "position": [0, 0], "velocity": [0.01, 0]},
      "fast": {"mass": 0.1, "particle": true, "position": [1, 5], "velocity": [3, 0]}},
    "forces": [{"type": "point_force", "i": "slow", "force": ["=40*(fast.x - slow.x) - 3*fast.vx", 0]},
               {"type": "point_force", "i": "fast", "force": ["=-40*(fast.x - slow.x) + 0.2*slow.vx", 0]}])--",
                         R"--("slow.x", "fast.x", "slow.vx", "fast.vx")--",
                         R"--({"type": "dynamics", "until": 1.5, "every": 1.5, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const auto slope = [](double, const ReferenceState& y) {
    return ReferenceState{y[2], y[3], (40 * (y[1] - y[0]) - 3 * y[3]) / 100, (-40 * (y[1] - y[0]) + 0.2 * y[2]) / 0.1};
  };
  const ReferenceState end = integrate(slope, {0, 1, 0.01, 3}, 1.5, 40000);
  EXPECT_NEAR(run.last("slow.x"), end[0], 1e-9);
  EXPECT_NEAR(run.last("fast.x"), end[1], 1e-9);
  EXPECT_NEAR(run.last("fast.vx"), end[3], 2e-8);
}

// Two mechanisms apart, each with a law that reads a point and a joint: models of their own carry their laws.
TEST(StateLaws, GoWithTheirMechanismsWhenTheseAreIntegratedApart) {
  const std::string parts = R"--("bodies": {
      "lazy": {"mass": 100, "particle": true, "position": [0.2, 0]},
      "post": {"fixed": true, "position": [0, -4], "points": {"top": [0, 1]}},
      "quick": {"mass": 1, "inertia": 0.001, "position": [7, 0], "points": {"rim": [0, 0.5]}, "angular_velocity": 5}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "quick", "at": [7, 0]}],
    "forces": [{"type": "point_force", "i": "lazy", "force": ["=-25*lazy.x", "=post.top.y + 3"]},
               {"type": "torque", "i": "quick", "torque": "=-3*(quick.rim.y - 0.5) - 2*pin.angle"}])--";
  const TextRun run = run_text(law_scene(parts, R"--("lazy.x", "lazy.y", "quick.angle")--",
                                         R"--({"type": "dynamics", "until": 2, "every": 2, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("lazy.x"), 0.2 * std::cos(0.5 * 2), 1e-9);
  EXPECT_NEAR(run.last("lazy.y"), 0, 1e-12);
  const auto slope = [](double, const ReferenceState& y) {
    return ReferenceState{y[1], (-3 * (0.5 * std::cos(y[0]) - 0.5) - 2 * y[0]) / 0.001};
  };
  EXPECT_NEAR(run.last("quick.angle"), integrate(slope, {0, 5}, 2, 200000)[0], 1e-8);
}

// A law that reads the force of a spring whose own force is a law, in joints' and springs' columns.
TEST(StateLaws, ReadEachOtherThroughSprings) {
  const TextRun run =
      run_text(law_scene(R"--("columns": {"error": "=guide.slide - 0.4"},
    "bodies": {"cart": {"mass": 2, "inertia": 1, "position": [0.1, 0]},
               "wheel": {"mass": 1, "inertia": 0.5, "position": [0, 3]}},
    "constraints": [{"type": "translational", "name": "guide", "i": "ground", "j": "cart", "axis_i": [1, 0]},
                    {"type": "revolute", "name": "pin", "i": "ground", "j": "wheel", "at": [0, 3]}],
    "forces": [{"type": "spring_damper", "name": "s", "i": ["ground", [-1, 0]], "j": "cart", "k": 30, "c": 2, "length": 1,
                "force": "=5*error + 0.3*guide.slide_rate + pin.omega"},
               {"type": "torsion_spring", "name": "w", "i": "ground", "j": "wheel", "k": 4, "angle": 0,
                "torque": "=0.5*s.force*s.length - 0.2*s.rate"},
               {"type": "torque", "i": "wheel", "torque": "=0.1*w.torque + 0.2*w.angle"}])--",
                         R"--("guide.slide", "wheel.angle", "s.force", "energy.balance")--",
                         R"--({"type": "dynamics", "until": 1.5, "every": 1.5, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const auto tension = [](const ReferenceState& y) {
    return 30 * y[0] + 2 * y[2] + 5 * (y[0] - 0.4) + 0.3 * y[2] + y[3];
  };
  const auto slope = [&](double, const ReferenceState& y) {
    const double s = tension(y), w = 4 * y[1] + 0.5 * s * (y[0] + 1) - 0.2 * y[2];
    return ReferenceState{y[2], y[3], -s / 2, (-w + 0.1 * w + 0.2 * y[1]) / 0.5};
  };
  const ReferenceState end = integrate(slope, {0.1, 0, 0, 0}, 1.5, 20000);
  EXPECT_NEAR(run.last("guide.slide"), end[0], 1e-9);
  EXPECT_NEAR(run.last("wheel.angle"), end[1], 1e-9);
  EXPECT_NEAR(run.last("s.force"), tension(end), 1e-8);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
}

TEST(StateLaws, AreRepeated) {
  const TextRun run = run_text(law_scene(R"--("replicate": [{"count": 3,
      "bodies": {"ball{k}": {"mass": 1, "particle": true, "position": ["=k", 0]}},
      "forces": [{"type": "point_force", "i": "ball{k}", "force": ["=-k^2*('ball{k}'.x - 0.5*k)", 0]}]
}])--",
                                         R"--("ball1.x", "ball2.x", "ball3.x")--",
                                         R"--({"type": "dynamics", "until": 1, "every": 1, "tolerance": 1e-11})--"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  for (int k = 1; k <= 3; ++k)
    EXPECT_NEAR(run.last("ball" + std::to_string(k) + ".x"), 0.5 * k * (1 + std::cos(k)), 1e-9);
}

// A table that ends: the motion ends where it is left.
TEST(StateLaws, EndAMotionWhereATableEnds) {
  const auto text = [](const std::string& beyond) {
    return law_scene(R"--("tables": {"field": {"x": [-1, 0, 1.25], "y": [0, 0, 0])--" + beyond + R"--(}},
      "bodies": {"mass": {"mass": 1, "particle": true, "velocity": [0.5, 0]}},
      "forces": [{"type": "point_force", "name": "pull", "i": "mass", "force": ["=field(mass.x)", 0]}])--",
                     R"--("mass.x")--", R"--({"type": "dynamics", "until": 4, "every": 0.5})--");
  };
  const TextRun run = run_text(text(""));
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::singular);
  EXPECT_NE(run.analysis().report.message.find("\"force\" of point_force \"pull\" is undefined at t = 2.5"),
            std::string::npos)
      << run.analysis().report.message;
  EXPECT_NE(run.analysis().report.message.find("table \"field\" reaches from -1 to 1.25"), std::string::npos)
      << run.analysis().report.message;
  EXPECT_EQ(run.last("t"), 2.5);
  EXPECT_EQ(run_text(text(R"--(, "beyond": "hold")--")).outcome.exit_code, 0);
}

TEST(StateLaws, EndAMotionWhereTheyHaveNoValue) {
  const TextRun run = run_text(law_scene(R"--("bodies": {"mass": {"mass": 1, "particle": true, "velocity": [-0.5, 0]}},
      "forces": [{"type": "point_force", "name": "pull", "i": "mass", "force": ["=0*sqrt(mass.x + 1)", 0]}])--",
                                         R"--("mass.x")--", R"--({"type": "dynamics", "until": 4, "every": 0.5})--"));
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_NE(run.analysis().report.message.find("\"pull\" is undefined beyond t = 2 s"), std::string::npos)
      << run.analysis().report.message;
}

}  // namespace
}  // namespace catena::testing
