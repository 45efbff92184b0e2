// Ropes over pulleys against closed forms and a scalar Lagrangian integration: Atwood's machine with massless and
// massive pulleys, movable pulleys, tackles, winches, swinging weights, jerks, elastic ropes. Ropes that meet and leave
// pulleys: rope_ways_test.cpp; in driven motions: driven_ropes_test.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/good_run.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;

std::string particle(const std::string& name, double mass, double x, double y, double vx = 0, double vy = 0) {
  return "\"" + name + R"(": {"particle": true, "mass": )" + text_of(mass) + R"(, "position": )" + pair_of(x, y) +
         R"(, "velocity": )" + pair_of(vx, vy) + "}";
}
std::string pulley(const std::string& at, double radius, const std::string& more = "") {
  return R"({"at": )" + at + R"(, "radius": )" + text_of(radius) + more + "}";
}
std::string on_ground(double x, double y) { return R"(["ground", )" + pair_of(x, y) + "]"; }
std::string rope(const std::string& i, const std::string& over, const std::string& j, const std::string& more = "") {
  return R"({"type": "rope", "name": "rope", "i": )" + i + R"(, "over": [)" + over + R"(], "j": )" + j + more + "}";
}
std::string scene(const std::string& bodies, const std::string& constraints, const std::string& forces,
                  const std::string& outputs, const std::string& analysis, double gravity = g) {
  return R"({"catena": 1, "gravity": [0, )" + text_of(-gravity) + R"(], "bodies": {)" + bodies +
         R"(}, "constraints": [)" + constraints + R"(], "forces": [)" + forces + R"(], "outputs": [)" + outputs +
         R"(], "analyses": [)" + analysis + "]}";
}
std::string dynamics(double t) {
  return R"({"type": "dynamics", "at": [0, )" + text_of(t) + R"(], "tolerance": 1e-11})";
}
TEST(Ropes, AtwoodsMachine) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double m1 = random(0.5, 5), m2 = random(0.5, 5), r = random(0.05, 0.4), t = 0.3;
    const double x = random(-2, 2), y = random(-2, 2), y1 = y - random(2, 3), y2 = y - random(2, 3);
    const TextRun run =
        good_run(scene(particle("a", m1, x - r, y1) + "," + particle("b", m2, x + r, y2), "",
                       rope("\"a\"", pulley(on_ground(x, y), r, R"(, "side": -1)"), "\"b\""),
                       R"("a.y", "b.y", "rope.force", "rope.length", "rope.gap", "energy.balance")", dynamics(t)));
    const double a = (m2 - m1) * g / (m1 + m2);
    EXPECT_NEAR(run.last("a.y"), y1 + a * t * t / 2, 1e-10);
    EXPECT_NEAR(run.last("b.y"), y2 - a * t * t / 2, 1e-10);
    EXPECT_NEAR(run.last("rope.force"), 2 * m1 * m2 * g / (m1 + m2), 1e-9);
    EXPECT_NEAR(run.last("rope.length"), (y - y1) + (y - y2) + pi * r, 1e-10);
    EXPECT_NEAR(run.last("rope.gap"), 0, 1e-10);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
  }
}

// The pulley takes part with its inertia; the two sides have tensions of their own.
TEST(Ropes, AtwoodsMachineWithAMassivePulley) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double m1 = random(0.5, 5), m2 = random(0.5, 5), r = random(0.05, 0.4), inertia = random(0.001, 0.5);
    const double y1 = -random(2, 3), y2 = -random(2, 3), t = 0.5;
    const std::string wheel = R"("wheel": {"mass": 1, "inertia": )" + text_of(inertia) + "}";
    const TextRun run = good_run(scene(
        particle("a", m1, -r, y1) + "," + particle("b", m2, r, y2) + "," + wheel,
        R"({"type": "revolute", "i": "ground", "j": "wheel"})",
        rope("\"a\"", pulley("\"wheel\"", r, R"(, "pulley": "rolls")"), "\"b\""),
        R"("a.y", "b.y", "wheel.angle", "rope.force", "rope:2.force", "rope.force_j", "energy.balance")", dynamics(t)));
    const double a = (m2 - m1) * g / (m1 + m2 + inertia / (r * r));
    EXPECT_NEAR(run.last("b.y"), y2 - a * t * t / 2, 1e-10);
    EXPECT_NEAR(run.last("a.y"), y1 + a * t * t / 2, 1e-10);
    EXPECT_NEAR(run.last("wheel.angle"), -a * t * t / 2 / r, 1e-9);
    EXPECT_NEAR(run.last("rope.force"), m1 * (g + a), 1e-9);
    EXPECT_NEAR(run.last("rope:2.force"), m2 * (g - a), 1e-9);
    EXPECT_EQ(run.last("rope.force_j"), run.last("rope:2.force"));
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
  }
}

// A tackle of n parallel parts between sheaves of the ground and of the load, pulled by a weight; n = 2 is the movable
// pulley. The end is made fast to the load itself where n is odd.
TEST(Ropes, Tackles) {
  for (int n = 1; n <= 7; ++n) {
    SCOPED_TRACE(n);
    RandomNumbers random(static_cast<unsigned>(n));
    const double r = 0.1, load = random(1, 5), pull = random(1, 3), t = 0.25;
    // Strand k at x = 2 r k; strand 0 is the weight's; sheave k between strands k and k + 1, above where k is even.
    std::string over;
    for (int k = 0; k < n; ++k) {
      const double x = r * (2 * k + 1);
      const bool above = k % 2 == 0;
      over += (k > 0 ? "," : "") + pulley(above ? on_ground(x, 0) : R"(["load", )" + pair_of(x, 0) + "]", r,
                                          above ? R"(, "side": -1)" : R"(, "side": 1)");
    }
    const double last = 2 * r * n;
    const std::string end = n % 2 == 0 ? on_ground(last, 0) : R"(["load", )" + pair_of(last, 0) + "]";
    const std::string bodies = particle("weight", pull, 0, -2) + R"(,"load": {"mass": )" + text_of(load) +
                               R"(, "inertia": 1, "position": [0, -3]})";
    const std::string guide = R"({"type": "translational", "i": "ground", "j": "load", "axis_i": [0, 1]})";
    const TextRun run =
        good_run(scene(bodies, guide, rope("\"weight\"", over, end),
                       R"("load.y", "weight.y", "rope.force", "rope.length", "energy.balance")", dynamics(t)));
    const double a = (n * pull - load) * g / (n * n * pull + load);
    EXPECT_NEAR(run.last("load.y"), -3 + a * t * t / 2, 1e-10);
    EXPECT_NEAR(run.last("weight.y"), -2 - n * a * t * t / 2, 1e-10);
    EXPECT_NEAR(run.last("rope.force"), pull * (g - n * a), 1e-9);
    EXPECT_NEAR(run.last("rope.length"), 2 + 3 * n + n * pi * r, 1e-10);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
  }
}

// A drum that a torque turns many times, and the rope that winds on it.
TEST(Ropes, WinchWithADrum) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double m = random(1, 5), r = random(0.02, 0.1), inertia = random(0.001, 0.1), t = 1.5;
    const int side = seed % 2 == 0 ? 1 : -1;
    const double a = random(1, 4), torque = r * (m * (g + a) + inertia * a / (r * r));
    // On the left of a rope that runs upwards a drum turns counter-clockwise as it winds.
    const std::string bodies =
        particle("load", m, side * r, -20) + R"(,"drum": {"mass": 2, "inertia": )" + text_of(inertia) + "}";
    const TextRun run = good_run(scene(
        bodies, R"({"type": "revolute", "i": "ground", "j": "drum"})",
        rope("\"load\"", pulley("\"drum\"", r, R"(, "pulley": "rolls", "side": )" + std::to_string(side)), "\"drum\"") +
            R"(,{"type": "torque", "i": "drum", "torque": )" + text_of(side * torque) + "}",
        R"("load.y", "drum.angle", "rope.force", "energy.balance")", dynamics(t)));
    EXPECT_NEAR(run.last("load.y"), -20 + a * t * t / 2, 1e-9);
    EXPECT_NEAR(run.last("drum.angle"), side * a * t * t / 2 / r, 1e-8);
    EXPECT_NEAR(run.last("rope.force"), m * (g + a), 1e-8);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// Weight 1 hangs on one side of a circle, weight 2 swings on the other: coordinates l, free length, and theta, its
// angle from the vertical, away from the circle.
//
//   u = l' - R theta'     M u' = m2 l theta'^2 - m1 g + m2 g cos theta     M = m1 + m2
//   m2 l^2 theta'' = m1 g R - m2 g (l sin theta + R cos theta) + R M u' - 2 m2 l l' theta'
struct SwingingWeight {
  double m1, m2, R;
  using State = std::array<double, 4>;  // l, theta, u, theta'

  State rates(const State& s) const {
    const auto& [l, theta, u, omega] = s;
    const double M = m1 + m2, l_rate = u + R * omega;
    const double u_rate = (m2 * l * omega * omega - m1 * g + m2 * g * std::cos(theta)) / M;
    const double turning = m1 * g * R - m2 * g * (l * std::sin(theta) + R * std::cos(theta)) + R * M * u_rate -
                           2 * m2 * l * l_rate * omega;
    return {l_rate, omega, u_rate, turning / (m2 * l * l)};
  }
  void advance(State& s, double t) const {
    constexpr int steps = 4000;
    const double h = t / steps;
    const auto plus = [](const State& a, double f, const State& b) {
      State c;
      for (std::size_t k = 0; k < 4; ++k) c[k] = a[k] + f * b[k];
      return c;
    };
    for (int n = 0; n < steps; ++n) {
      const State a = rates(s), b = rates(plus(s, h / 2, a)), c = rates(plus(s, h / 2, b)), d = rates(plus(s, h, c));
      for (std::size_t k = 0; k < 4; ++k) s[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
  }
};

TEST(Ropes, SwingingWeightsAgainstLagrange) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const SwingingWeight swing{random(1.5, 3), random(1, 1.4), random(0.02, 0.3)};
    const double t = 0.7, depth = random(2, 3), x = random(-1, 1), y = random(-1, 1);
    SwingingWeight::State s{random(2, 3), random(-0.8, 1.2), 0, random(-1, 1)};
    const bool mirrored = seed % 2 == 0, reversed = seed % 3 == 0;
    const double sign = mirrored ? -1 : 1;
    const auto place = [&] {
      const double c = std::cos(s[1]), n = std::sin(s[1]);
      return std::array{x + sign * (swing.R * c + s[0] * n), y + swing.R * n - s[0] * c};
    };
    const auto at = place();
    // v = u d + l theta' e
    const double vx = sign * s[0] * s[3] * std::cos(s[1]), vy = s[0] * s[3] * std::sin(s[1]);
    const std::string bodies =
        particle("a", swing.m1, x - sign * swing.R, y - depth) + "," + particle("b", swing.m2, at[0], at[1], vx, vy);
    const int side = (mirrored ? 1 : -1) * (reversed ? -1 : 1);
    const std::string way = pulley(on_ground(x, y), swing.R, R"(, "side": )" + std::to_string(side));
    const TextRun run = good_run(scene(bodies, "", reversed ? rope("\"b\"", way, "\"a\"") : rope("\"a\"", way, "\"b\""),
                                       R"("a.y", "b.x", "b.y", "rope.force", "energy.balance")", dynamics(t)));
    const double l0 = s[0], theta0 = s[1];
    swing.advance(s, t);
    const auto end = place();
    EXPECT_NEAR(run.last("b.x"), end[0], 1e-8);
    EXPECT_NEAR(run.last("b.y"), end[1], 1e-8);
    EXPECT_NEAR(run.last("a.y"), y - depth + (s[0] - l0) - swing.R * (s[1] - theta0), 1e-8);
    EXPECT_NEAR(run.last("rope.force"), swing.m1 * (g + swing.rates(s)[2]), 1e-7);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9);
  }
}

// A slack rope becomes taut with a jerk: the momentum along it is shared.
TEST(Ropes, Jerk) {
  for (const double restitution : {0.0, 0.5}) {
    const double m1 = 3, m2 = 2, r = 0.1, slack = 0.3;
    const TextRun run = good_run(scene(
        particle("b", m2, r, -2) + R"(,"a": {"particle": true, "mass": 3, "position": [-0.1, -2]})",
        R"({"type": "absolute_x", "i": "a"}, {"type": "absolute_x", "i": "b"})",
        R"({"type": "contact", "name": "floor", "i": "ground", "j": "a", "curve": {"line": {"point": [0, -2], "axis": [1, 0]}}},)" +
            rope("\"a\"", pulley(on_ground(0, 0), r), "\"b\"",
                 R"(, "length": )" + text_of(4 + pi * r + slack) + R"(, "restitution": )" + text_of(restitution)),
        R"("a.vy", "b.vy", "rope.gap")", dynamics(std::sqrt(2 * slack / g) + 1e-9)));
    const double v = std::sqrt(2 * g * slack);
    // Relative velocity after: -restitution times that before.
    const double va = (1 + restitution) * m2 * v / (m1 + m2), vb = v - (1 + restitution) * m1 * v / (m1 + m2);
    EXPECT_NEAR(run.last("a.vy"), va, 1e-7);
    EXPECT_NEAR(run.last("b.vy"), -vb, 1e-7);
    EXPECT_NEAR(run.last("rope.gap"), 0, 1e-8);
  }
}

TEST(Ropes, ElasticRopesOscillate) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double m = random(1, 4), k = random(500, 3000), r = random(0.05, 0.3), t = random(0.3, 0.9);
    const std::string stiff = R"(, "k": )" + text_of(k);
    // The end at rest: x = m g (1 - cos w t) / k.
    const TextRun hung =
        good_run(scene(particle("b", m, r, -2), "", rope(on_ground(-r, -1), pulley(on_ground(0, 0), r), "\"b\"", stiff),
                       R"("b.y", "rope.force", "rope.gap", "energy.balance")", dynamics(t)));
    const double x = m * g / k * (1 - std::cos(std::sqrt(k / m) * t));
    EXPECT_NEAR(hung.last("b.y"), -2 - x, 1e-8);
    EXPECT_NEAR(hung.last("rope.force"), k * x, 1e-5);
    EXPECT_NEAR(hung.last("rope.gap"), -x, 1e-8);
    EXPECT_NEAR(hung.last("energy.balance"), 0, 1e-8);
    // A movable pulley: both parts lengthen.
    const TextRun carried =
        good_run(scene(particle("b", m, 0, -2), "", rope(on_ground(-r, 0), pulley("\"b\"", r), on_ground(r, 0), stiff),
                       R"("b.y", "rope.force", "energy.balance")", dynamics(t)));
    const double z = m * g / (4 * k) * (1 - std::cos(std::sqrt(4 * k / m) * t));
    EXPECT_NEAR(carried.last("b.y"), -2 - z, 1e-8);
    EXPECT_NEAR(carried.last("rope.force"), 2 * k * z, 1e-5);
  }
}

// Two weights on an elastic rope, both guided: they move together, and against each other at w^2 = k (1/m1 + 1/m2).
TEST(Ropes, ModesOfWeightsOnAnElasticRope) {
  const double m1 = 2, m2 = 3, k = 400, r = 0.2, T = 20;
  const TextRun run = good_run(scene(
      particle("a", m1, -r, -2) + "," + particle("b", m2, r, -3),
      R"({"type": "absolute_x", "i": "a"}, {"type": "absolute_x", "i": "b"})",
      rope("\"a\"", pulley(on_ground(0, 0), r), "\"b\"", R"(, "k": 400, "length": )" + text_of(5 + pi * r - T / k)) +
          R"(,{"type": "point_force", "i": "a", "force": [0, -20]}, {"type": "point_force", "i": "b", "force": [0, -20]})",
      R"("a.y")", R"({"type": "modes"})", 0));
  const std::vector<double> squares = run.column("omega2");
  ASSERT_EQ(squares.size(), 2u);
  EXPECT_NEAR(squares[0], 0, 1e-8);
  EXPECT_NEAR(squares[1], k * (1 / m1 + 1 / m2), 1e-7);
}

// A knot with a weight between two ropes over pegs: its directions are those of the triangle of forces.
TEST(Ropes, WeightBetweenTwoPegs) {
  // A search whose particles come into a pulley's circle, where the rope has no length, ends without an answer.
  int unsolved = 0;
  for (unsigned seed = 1; seed <= size_of_test(20u, 4u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double m1 = random(2, 3), m2 = random(2, 3), m3 = random(1.5, 3), r = random(0, 0.2);
    const std::string ropes = rope("\"a\"", pulley(on_ground(-2, 0), r, R"(, "side": -1)"), "\"c\"") +
                              R"(,{"type": "rope", "name": "other", "i": "c", "over": [)" +
                              pulley(on_ground(2, 0), r, R"(, "side": -1)") + R"(], "j": "b"})";
    const TextRun run = run_text(
        scene(particle("a", m1, -2 - r, -4) + "," + particle("b", m2, 2 + r, -4) + "," + particle("c", m3, 0, -0.7), "",
              ropes, R"("c.x", "c.y", "rope.force", "other.force", "rope.length")", R"({"type": "equilibrium"})"));
    ASSERT_LT(run.outcome.exit_code, 2) << run.outcome.error_text;
    if (!run.analysis().report.ok()) {
      ++unsolved;
      continue;
    }
    EXPECT_NEAR(run.last("rope.force"), m1 * g, 1e-8);
    EXPECT_NEAR(run.last("other.force"), m2 * g, 1e-8);
    // Angles of the two parts from the vertical, law of cosines.
    const double a1 = std::acos((m1 * m1 + m3 * m3 - m2 * m2) / (2 * m1 * m3));
    const double a2 = std::acos((m2 * m2 + m3 * m3 - m1 * m1) / (2 * m2 * m3));
    const double x = run.last("c.x"), y = run.last("c.y");
    // The straight part from the knot touches the circle: its distance from the centre is r.
    EXPECT_NEAR((-2 - x) * std::cos(a1) - (0 - y) * -std::sin(a1), -r, 1e-7);
    EXPECT_NEAR((2 - x) * std::cos(a2) - (0 - y) * std::sin(a2), r, 1e-7);
  }
  EXPECT_LE(unsolved, 2);
}

// A weight that slides along a rope between two points finds the lowest place of an ellipse: both parts are inclined
// alike, sin = d / L. With a spring in place of the rope the length is that under its tension.
TEST(Ropes, WeightThatSlidesAlongARope) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double d = random(1, 3), h = random(-0.5, 0.5), L = d * random(1.3, 2), m = random(1, 5),
                 k = random(300, 3000);
    const bool elastic = seed % 2 == 0;
    const TextRun run =
        good_run(scene(particle("bead", m, 0.4 * d, -1), "",
                       rope(on_ground(0, 0), pulley("\"bead\"", 0), on_ground(d, h),
                            R"(, "length": )" + text_of(L) + (elastic ? R"(, "k": )" + text_of(k) : "")),
                       R"("bead.x", "bead.y", "rope.force", "rope.length", "rope.gap")", R"({"type": "equilibrium"})"));
    const double now = run.last("rope.length");
    if (elastic) {
      EXPECT_NEAR(run.last("rope.force"), k * (now - L), 1e-6);
    } else {
      EXPECT_NEAR(now, L, 1e-9);
    }
    const double fall = std::sqrt(now * now - d * d);
    EXPECT_NEAR(run.last("rope.force"), m * g * now / (2 * fall), 1e-7);
    EXPECT_NEAR(run.last("bead.y"), (h - fall) / 2, 1e-8);
    EXPECT_NEAR(run.last("bead.x"), d / 2 * (1 - h / fall), 1e-7);
  }
}

// Without gravity a weight swings out along the involute: l^2 = l0^2 + 2 R v t until the rope is straight; then round
// its other end.
TEST(Ropes, SwingsOffItsPulley) {
  const double R = 0.2, l0 = 1, v = 2, start = -0.5;
  // The fixed part lies at the angle `theta` = pi / 2, level above the circle.
  const double contact = pi / 2 - start, end = l0 + R * contact, t = (end * end - l0 * l0) / (2 * R * v);
  const double c = std::cos(start), n = std::sin(start), later = 0.6, turned = v * later / (2 + end);
  const TextRun run = run_text(scene(
      particle("b", 1, R * c + l0 * n, R * n - l0 * c, v * c, v * n), "",
      rope(on_ground(-2, R), pulley(on_ground(0, 0), R), "\"b\""), R"("b.x", "b.y")",
      R"({"type": "dynamics", "at": [)" + text_of(t) + "," + text_of(t + later) + R"(], "tolerance": 1e-11})", 0));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  EXPECT_NEAR(run.first("b.x"), end, 1e-8);
  EXPECT_NEAR(run.first("b.y"), R, 1e-8);
  EXPECT_NEAR(run.last("b.x"), -2 + (2 + end) * std::cos(turned), 1e-8);
  EXPECT_NEAR(run.last("b.y"), R + (2 + end) * std::sin(turned), 1e-8);
}

}  // namespace
}  // namespace catena::testing
