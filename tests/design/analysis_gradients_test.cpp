// Gradients of equilibria, loads, frequencies, reactions and motions against closed forms.
#include <gtest/gtest.h>

#include <numbers>

#include "design/measured.hpp"

namespace catena::testing {
namespace {

// A rod of length L and mass m, held at one end by a pin and a torsion spring k without load at the angle 0:
// k a + m g L/2 cos a = 0.
TEST(StaticGradients, OfARodOnATorsionSpring) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
  "parameters": {"m": 2, "L": 0.8, "k": 9},
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": ["L", 0]}, "mass": "m"}},
  "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "rod", "k": "k", "angle": 0}],
  "outputs": ["rod.angle", "pin.fy"],
  "analyses": [{"type": "sensitivity", "parameters": ["m", "L", "k"], "verify": true,
    "of": {"type": "equilibrium", "measures": {"angle": {"final": "rod.angle"}, "energy": {"field": "energy"},
                                               "hold": {"max": "pin.fy"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double m = 2, L = 0.8, k = 9, g = 9.81, a = value(run, "angle");
  EXPECT_NEAR(k * a + m * g * L / 2 * std::cos(a), 0, 1e-9);
  const double bend = k - m * g * L / 2 * std::sin(a);
  EXPECT_NEAR(gradient(run, "angle", 0), -g * L / 2 * std::cos(a) / bend, 1e-10);
  EXPECT_NEAR(gradient(run, "angle", 1), -m * g / 2 * std::cos(a) / bend, 1e-10);
  EXPECT_NEAR(gradient(run, "angle", 2), -a / bend, 1e-10);
  EXPECT_NEAR(gradient(run, "energy", 0), g * L / 2 * std::sin(a), 1e-10);
  EXPECT_NEAR(gradient(run, "energy", 2), a * a / 2, 1e-10);
  EXPECT_NEAR(gradient(run, "hold", 0), g, 1e-9);
  EXPECT_NEAR(run.first("d(rod.angle)/d(k)"), -a / bend, 1e-10);
  EXPECT_LT(field<double>(run, "deviation"), 1e-5);
}

TEST(StaticGradients, OfWhatTouchesWithoutAForceAreNone) {
  // A ball that lies on a stop exactly where its spring would leave it.
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"k": 5},
  "bodies": {"ball": {"mass": 1, "particle": true, "position": [0, 0]}},
  "constraints": [{"type": "absolute_x", "i": "ball", "value": 0}],
  "forces": [{"type": "spring_damper", "i": ["ground", [0, 1]], "j": "ball", "k": "k", "length": 1},
             {"type": "stop", "name": "floor", "column": "ball.y", "min": 0}],
  "outputs": ["ball.y"],
  "analyses": [{"type": "sensitivity", "parameters": ["k"], "of": {"type": "equilibrium"}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(run.first("d(ball.y)/d(k)")));
  ASSERT_FALSE(run.analysis().report.warnings.empty());
}

// A rigid strut on a torsion spring under a load from above: P L = k.
TEST(LoadGradients, OfAStrutOnATorsionSpring) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"L": 0.7, "k": 40, "P": 0},
  "bodies": {"strut": {"rod": {"from": [0, 0], "to": [0, "L"]}, "mass": 0}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "strut.from"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "strut", "k": "k"},
             {"type": "point_force", "i": "strut.to", "force": [0, "=-P"]}],
  "analyses": [{"type": "sensitivity", "parameters": ["k", "L"],
    "of": {"type": "buckling", "parameter": "P", "measures": {"load": {"field": "loads[1]"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(value(run, "load"), 40 / 0.7, 1e-8);
  EXPECT_NEAR(gradient(run, "load", 0), 1 / 0.7, 1e-9);
  EXPECT_NEAR(gradient(run, "load", 1), -40 / 0.49, 1e-8);
}

// A physical pendulum: omega^2 = m g s / (J + m s^2), s the distance of the pivot.
TEST(FrequencyGradients, OfAPendulum) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"m": 3, "s": 0.4, "J": 0.2},
  "bodies": {"bob": {"mass": "m", "inertia": "J", "position": [0, "=-s"], "points": {"pivot": [0, "s"]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "bob.pivot"}],
  "analyses": [{"type": "sensitivity", "parameters": ["m", "s", "J"], "verify": true,
    "of": {"type": "modes", "measures": {"square": {"field": "omega2[1]"}, "omega": {"field": "omega[1]"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double m = 3, s = 0.4, J = 0.2, g = 9.81, I = J + m * s * s, square = m * g * s / I;
  EXPECT_NEAR(value(run, "square"), square, 1e-9);
  EXPECT_NEAR(gradient(run, "square", 0), g * s * J / (I * I), 1e-9);
  EXPECT_NEAR(gradient(run, "square", 1), m * g * (J - m * s * s) / (I * I), 1e-9);
  EXPECT_NEAR(gradient(run, "square", 2), -m * g * s / (I * I), 1e-9);
  EXPECT_NEAR(gradient(run, "omega", 2), -m * g * s / (I * I) / (2 * std::sqrt(square)), 1e-9);
  EXPECT_LT(field<double>(run, "deviation"), 1e-6);
}

// A pendulum on a torsion spring: "verify" lets the place of an equilibrium before move as the derivatives do.
TEST(FrequencyGradients, AboutAnEquilibriumAreVerifiedWithIt) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"k": 9, "m": 1.5},
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": [0.6, 0]}, "mass": "m"}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "rod.from"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "rod", "k": "k"}], "outputs": ["rod.angle"],
  "analyses": [{"type": "equilibrium"}, {"type": "sensitivity", "parameters": ["k", "m"], "verify": true,
    "of": {"type": "modes", "measures": {"square": {"field": "omega2[1]"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  // k a + w cos(a) = 0, J omega2 = k - w sin(a), w = m g l/2, J = m l^2/3
  const double k = 9, m = 1.5, w = m * 9.81 * 0.3, J = m * 0.12, a = run.last("rod.angle");
  ASSERT_NEAR(k * a + w * std::cos(a), 0, 1e-10);
  const double turn = -a / (k - w * std::sin(a));
  ASSERT_EQ(run.analysis(1).measures.size(), 1u);
  EXPECT_NEAR(run.analysis(1).measures[0].gradient.at(0), (1 - w * std::cos(a) * turn) / J, 1e-9 / J);
  double deviation = 1;
  for (const NamedField& f : run.analysis(1).fields) {
    if (f.name == "deviation") deviation = std::get<double>(f.value);
  }
  EXPECT_LT(deviation, 1e-6);
}

// What bends within a thousandth of the parameter: d exp(3000 (L - 1)) = 3000.
TEST(VerifiedGradients, OfWhatStepsOfDifferencesAreTooLongFor) {
  const TextRun run = run_text(R"_({"catena": 1, "parameters": {"L": 1},
  "bodies": {"ball": {"mass": 1, "particle": true, "position": ["L", 0]}},
  "constraints": [{"type": "absolute_x", "i": "ball", "value": "L"}, {"type": "absolute_y", "i": "ball", "value": 0}],
  "analyses": [{"type": "sensitivity", "parameters": ["L"], "verify": true,
    "of": {"type": "equilibrium", "measures": {"steep": {"final": "=exp(3000*(ball.x-1))"}}}}]})_");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(gradient(run, "steep", 0), 3000, 1e-6);
  EXPECT_LT(field<double>(run, "deviation"), 1e-5);
}

// A ball in oil that has come to rest: what its energy has is rounding, and so are derivatives of it.
TEST(VerifiedGradients, OfWhatIsRoundingOfZero) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"c": 40},
  "bodies": {"ball": {"mass": 1, "particle": true, "velocity": [1, 0]}},
  "constraints": [{"type": "absolute_y", "i": "ball", "value": 0}],
  "forces": [{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "ball", "k": 0, "c": "c"}],
  "analyses": [{"type": "sensitivity", "parameters": ["c"], "verify": true, "of": {"type": "dynamics", "until": 3,
    "every": 1, "measures": {"rest": {"final": "energy.kinetic"}, "way": {"final": "ball.x"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(gradient(run, "way", 0), -1 / 1600.0, 1e-9);
  EXPECT_LT(std::abs(value(run, "rest")), 1e-13);
  EXPECT_LT(field<double>(run, "deviation"), 1e-4);
}

TEST(FrequencyGradients, OfDoubleOnesAreRefused) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"k": 7},
  "bodies": {"a": {"mass": 2, "particle": true}, "b": {"mass": 2, "particle": true, "position": [1, 0]}},
  "constraints": [{"type": "absolute_y", "i": "a", "value": 0}, {"type": "absolute_y", "i": "b", "value": 0}],
  "forces": [{"type": "spring_damper", "i": "ground", "j": "a", "k": "k", "length": 0},
             {"type": "spring_damper", "i": ["ground", [1, 0]], "j": "b", "k": 7, "length": 0}],
  "analyses": [{"type": "sensitivity", "parameters": ["k"],
    "of": {"type": "modes", "measures": {"low": {"field": "omega2[1]"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_TRUE(std::isnan(gradient(run, "low", 0)));
  ASSERT_FALSE(run.analysis().report.warnings.empty());
  EXPECT_NE(run.analysis().report.warnings.front().find("mode 1 is one of two"), std::string::npos);
}

// A crank under gravity that turns at w: the drive holds m g L/2 cos(w t), the pin carries m (g - w^2 L/2 sin w t).
TEST(ReactionGradients, OfADrivenRod) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"m": 2, "L": 0.8, "w": 3},
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": ["L", 0]}, "mass": "m"}},
  "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "rod", "value": {"polynomial": [0, "w"]}}],
  "outputs": ["drive.load", "pin.fy"],
  "analyses": [{"type": "sensitivity", "parameters": ["m", "L", "w"],
    "of": {"type": "inverse_dynamics", "until": 2, "every": 0.25}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double m = 2, L = 0.8, w = 3, g = 9.81;
  const std::vector<double> t = run.column("t");
  ASSERT_EQ(t.size(), 9u);
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double c = std::cos(w * t[k]), s = std::sin(w * t[k]);
    EXPECT_NEAR(run.column("d(drive.load)/d(m)")[k], g * L / 2 * c, 1e-11);
    EXPECT_NEAR(run.column("d(drive.load)/d(w)")[k], -m * g * L / 2 * s * t[k], 1e-11);
    EXPECT_NEAR(run.column("d(pin.fy)/d(L)")[k], -m * w * w / 2 * s, 1e-11);
    EXPECT_NEAR(run.column("d(pin.fy)/d(w)")[k], -m * L / 2 * (2 * w * s + w * w * c * t[k]), 1e-10);
  }
}

// x = x0 cos(sqrt(k/m) t)
TEST(MotionGradients, OfAnOscillator) {
  const TextRun run = run_text(R"({"catena": 1, "parameters": {"m": 1.5, "k": 6, "x0": 0.7},
  "bodies": {"mass": {"mass": "m", "particle": true, "position": ["x0", 0]}},
  "constraints": [{"type": "absolute_y", "i": "mass", "value": 0}],
  "forces": [{"type": "spring_damper", "name": "spring", "i": "ground", "j": "mass", "k": "k", "length": 0}],
  "outputs": ["mass.x", "mass.vx", "mass.ax"],
  "analyses": [{"type": "sensitivity", "parameters": ["m", "k", "x0"],
    "of": {"type": "dynamics", "until": 3, "every": 0.3, "tolerance": 1e-11, "measures": {
      "square": {"integral": "=mass.x^2"}, "least": {"min": "mass.x"}, "end": {"final": "mass.x"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double m = 1.5, k = 6, x0 = 0.7, w = std::sqrt(k / m);
  const std::vector<double> t = run.column("t");
  ASSERT_EQ(t.size(), 11u);
  for (std::size_t r = 0; r < t.size(); ++r) {
    const double by_w = -x0 * t[r] * std::sin(w * t[r]);
    EXPECT_NEAR(run.column("d(mass.x)/d(k)")[r], by_w / (2 * m * w), 1e-9);
    EXPECT_NEAR(run.column("d(mass.x)/d(m)")[r], -by_w * w / (2 * m), 1e-9);
    EXPECT_NEAR(run.column("d(mass.x)/d(x0)")[r], std::cos(w * t[r]), 1e-9);
    EXPECT_NEAR(run.column("d(mass.vx)/d(x0)")[r], -w * std::sin(w * t[r]), 1e-9);
    EXPECT_NEAR(run.column("d(mass.ax)/d(x0)")[r], -w * w * std::cos(w * t[r]), 1e-9);
  }
  const double square_by_x0 = 2 * x0 * (1.5 + std::sin(6 * w) / (4 * w));
  EXPECT_NEAR(gradient(run, "square", 2), square_by_x0, 1e-9);
  EXPECT_NEAR(gradient(run, "least", 2), -1, 1e-9);
  EXPECT_NEAR(gradient(run, "least", 1), 0, 1e-8);
  EXPECT_NEAR(gradient(run, "end", 2), std::cos(3 * w), 1e-9);
}

// A double pendulum from a start that moves with its lengths, against differences of whole runs.
TEST(MotionGradients, OfADoublePendulumAgreeWithDifferences) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"a": 0.6, "b": 0.5, "w": 1.2},
  "bodies": {
    "upper": {"rod": {"from": [0, 0], "to": ["a", 0]}, "mass": 1.5, "angular_velocity": "w"},
    "lower": {"rod": {"from": ["a", 0], "to": ["=a+b*0.6", "=-b*0.8"]}, "mass": 0.7}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "upper.from"},
                  {"type": "revolute", "name": "pin", "i": "upper.to", "j": "lower.from"}],
  "outputs": ["lower.to.x", "lower.to.vy", "pin.fx", "lower.alpha"],
  "analyses": [{"type": "sensitivity", "parameters": ["a", "b", "w"], "verify": true,
    "of": {"type": "dynamics", "until": 1, "every": 0.1, "tolerance": 1e-11, "measures": {
      "far": {"max": "lower.to.x"}, "work": {"integral": "=pin.fx^2"}}}}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_LT(field<double>(run, "deviation"), 2e-6);
}

}  // namespace
}  // namespace catena::testing
