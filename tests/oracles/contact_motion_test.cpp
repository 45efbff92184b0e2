// Motion with impacts and contact against closed forms: random bodies on slopes, discs that meet, floors that yield,
// stops that let go.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "oracles/contact_runs.hpp"

namespace catena::testing {
namespace {

// A ball of restitution e on a slope without friction: in the slope's frame every flight is a parabola.
TEST(ContactMotion, BallsBounceDownSlopes) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double slope = random(-0.6, 0.6), e = random(0.3, 0.95), radius = random(0, 0.1), mass = random(0.1, 5);
    const double height = random(0.1, 1), along = random(-1, 1), up = random(-1, 1), s0 = random(-0.5, 0.5);
    const double c = std::cos(slope), s = std::sin(slope);
    // Across the slope: n, along it: w.
    const double n0 = height, a = earth_gravity * c, b = earth_gravity * s;
    std::vector<double> hits;
    double t = 0, n = n0, v = up, v_end = 0;
    for (int k = 0; k < 5; ++k) {
      const double flight = (v + std::sqrt(v * v + 2 * a * n)) / a;
      t += flight;
      v = e * (a * flight - v);
      n = 0;
      hits.push_back(t);
    }
    v_end = v;
    const double later = v_end / a;  // at the top of the flight after the fifth hit
    const double end = t + later;
    const std::string position = pair_of(s0 * c + (n0 + radius) * s, -s0 * s + (n0 + radius) * c);
    const std::string velocity = pair_of(along * c + up * s, -along * s + up * c);
    const TextRun run =
        run_text(R"({"catena":1, "gravity":[0,-9.81], "bodies": {"ball": {"particle": true, "mass": )" + text_of(mass) +
                 R"(, "position": )" + position + R"(, "velocity": )" + velocity + R"(}}, "forces": [{"type": "contact",
        "name": "slope", "i": "ground", "j": "ball", "radius": )" +
                 text_of(radius) + R"(, "restitution": )" + text_of(e) + "," + ground_line(slope) +
                 R"(}], "outputs": ["ball.x", "ball.y", "energy.balance"],)" + dynamics({end}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> found = instants(run, "impact");
    ASSERT_EQ(found.size(), hits.size());
    for (std::size_t k = 0; k < hits.size(); ++k) EXPECT_NEAR(found[k], hits[k], 1e-10);
    const double n_end = v_end * v_end / (2 * a) + radius, w_end = s0 + along * end + b * end * end / 2;
    EXPECT_NEAR(run.last("ball.x"), w_end * c + n_end * s, 1e-9);
    EXPECT_NEAR(run.last("ball.y"), -w_end * s + n_end * c, 1e-9);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-9 * mass);
  }
}

// Ever smaller bounces end at t1 (1 + e) / (1 - e); what is left rests.
TEST(ContactMotion, AccumulatedBouncesEndInContact) {
  for (const double e : {0.0, 0.2, 0.5, 0.8, 0.9}) {
    SCOPED_TRACE(e);
    const double fall = std::sqrt(2 * 0.95 / earth_gravity), end = fall * (1 + e) / (1 - e);
    const TextRun run = run_text(
        R"({"catena":1, "gravity":[0,-9.81], "bodies": {"ball": {"particle": true, "mass": 2, "position": [0,1]}},
        "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "ball", "radius": 0.05, "restitution": )" +
        text_of(e) + "," + ground_line(0) +
        R"(}], "outputs": ["ball.y", "ball.vy", "floor.force", "energy.dissipated"],)" + dynamics({end + 0.5}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    ASSERT_EQ(instants(run, "contact").size(), 1u);
    EXPECT_NEAR(instants(run, "contact").back(), end, 1e-3);
    EXPECT_NEAR(run.last("ball.y"), 0.05, 1e-12);
    EXPECT_NEAR(run.last("ball.vy"), 0, 1e-12);
    EXPECT_NEAR(run.last("floor.force"), 2 * earth_gravity, 1e-9);
    EXPECT_NEAR(run.last("energy.dissipated"), 2 * earth_gravity * 0.95, 1e-8);
  }
}

// Two discs without friction: speeds along the line of centres are exchanged, the others stay.
TEST(ContactMotion, DiscsMeet) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double ra = random(0.02, 0.1), rb = random(0.02, 0.1), ma = random(0.2, 3), mb = random(0.2, 3);
    const double e = random(0, 1), speed = random(1, 3), off = random(-0.8, 0.8) * (ra + rb), omega = random(-3, 3);
    const double distance = 0.5, reach = std::sqrt((ra + rb) * (ra + rb) - off * off), t = (distance - reach) / speed;
    const double nx = reach / (ra + rb), ny = off / (ra + rb), impulse = (1 + e) * speed * nx / (1 / ma + 1 / mb);
    const double later = 0.3;
    const TextRun run = run_text(R"({"catena":1, "bodies": {"a": {"mass": )" + text_of(ma) +
                                 R"(, "inertia": 0.01, "velocity": )" + pair_of(speed, 0) + R"(}, "b": {"mass": )" +
                                 text_of(mb) + R"(, "inertia": 0.01, "position": )" + pair_of(distance, off) +
                                 R"(, "angular_velocity": )" + text_of(omega) + R"(}}, "forces": [{"type": "contact",
        "i": "a", "j": "b", "curve": {"circle": {"centre": [0,0], "radius": )" +
                                 text_of(ra) + R"(}}, "radius": )" + text_of(rb) + R"(, "restitution": )" + text_of(e) +
                                 R"(}], "outputs": ["a.x","a.y","b.x","b.y","b.omega"],)" + dynamics({t + later}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    ASSERT_EQ(instants(run, "impact").size(), 1u);
    EXPECT_NEAR(instants(run, "impact")[0], t, 1e-11);
    EXPECT_NEAR(run.last("a.x"), speed * t + (speed - impulse / ma * nx) * later, 1e-9);
    EXPECT_NEAR(run.last("a.y"), -impulse / ma * ny * later, 1e-9);
    EXPECT_NEAR(run.last("b.x"), distance + impulse / mb * nx * later, 1e-9);
    EXPECT_NEAR(run.last("b.y"), off + impulse / mb * ny * later, 1e-9);
    EXPECT_NEAR(run.last("b.omega"), omega, 1e-12);
  }
}

// A compliant floor with damping: a damped oscillation about the static depth until the force is none.
TEST(ContactMotion, CompliantFloorsPressAndRelease) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double mass = random(0.5, 4), k = random(5e3, 1e5), zeta = seed % 3 == 0 ? 0 : random(0.01, 0.3);
    const double height = random(0.05, 0.5), c = 2 * zeta * std::sqrt(k * mass);
    const double omega = std::sqrt(k / mass), delta = zeta * omega, damped = omega * std::sqrt(1 - zeta * zeta);
    const double fall = std::sqrt(2 * height / earth_gravity), v0 = -earth_gravity * fall,
                 rest = -earth_gravity / (omega * omega);
    // y(t) = rest + exp(-delta t) (-rest cos + (v0 - delta rest) / damped sin)
    const auto y = [&](double t) {
      const double p = -rest, r = (v0 + delta * p) / damped;
      return rest + std::exp(-delta * t) * (p * std::cos(damped * t) + r * std::sin(damped * t));
    };
    const auto rate = [&](double t) {
      const double p = -rest, r = (v0 + delta * p) / damped;
      return std::exp(-delta * t) *
             ((r * damped - delta * p) * std::cos(damped * t) - (p * damped + delta * r) * std::sin(damped * t));
    };
    const auto force = [&](double t) { return -k * y(t) - c * rate(t); };
    // The force ceases between a quarter and a whole period.
    double a = 0.25 * 2 * M_PI / damped, b = a;
    while (force(b) > 0) b += 0.01 / damped;
    for (int n = 0; n < 200; ++n) (force((a + b) / 2) > 0 ? a : b) = (a + b) / 2;
    const double later = 0.05, depth = y(b), v = rate(b);
    const TextRun run = run_text(R"({"catena":1, "gravity":[0,-9.81], "bodies": {"ball": {"particle": true, "mass": )" +
                                 text_of(mass) + R"(, "position": )" + pair_of(0, height) +
                                 R"(}}, "forces": [{"type": "contact", "i": "ground", "j": "ball",
        "k": )" + text_of(k) + R"(, "c": )" +
                                 text_of(c) + "," + ground_line(0) +
                                 R"(}], "outputs": ["ball.y", "contact#1.force", "energy.balance"],)" +
                                 dynamics({fall + b / 2, fall + b + later}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(run.first("ball.y"), y(b / 2), 1e-9);
    EXPECT_NEAR(run.first("contact#1.force"), force(b / 2), 1e-6 * k * height);
    EXPECT_NEAR(run.last("ball.y"), depth + v * later - earth_gravity * later * later / 2, 1e-8);
    ASSERT_EQ(instants(run, "contact").size(), 1u);
    ASSERT_EQ(instants(run, "release").size(), 1u);
    EXPECT_NEAR(instants(run, "contact")[0], fall, 1e-9);
    EXPECT_NEAR(instants(run, "release")[0], fall + b, 1e-7);
    EXPECT_TRUE(instants(run, "impact").empty());
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8 * mass);
  }
}

// A mass that rests on a stop is lifted by a growing force: it leaves where that is its weight.
TEST(ContactMotion, StopsLetGo) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    // m y'' = f t - m g from t = m g / f on.
    const double mass = random(0.5, 3), rate = random(5, 40), leave = mass * earth_gravity / rate,
                 later = random(0.1, 0.5);
    const double end = leave + later;
    const TextRun run = run_text(
        R"({"catena":1, "gravity":[0,-9.81], "bodies": {"ball": {"particle": true, "mass": )" + text_of(mass) +
        R"(}}, "constraints": [{"type": "absolute_x", "i": "ball", "value": 0}], "forces": [{"type": "stop", "name": "bed",
        "column": "ball.y", "min": 0}, {"type": "point_force", "i": "ball", "force": [0, {"polynomial": [0, )" +
        text_of(rate) + R"(]}]}], "outputs": ["ball.y", "bed.force"],)" + dynamics({leave / 2, end}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(instants(run, "release").size(), 1u);
    EXPECT_NEAR(instants(run, "release")[0], leave, 1e-9);
    EXPECT_NEAR(run.first("bed.force"), mass * earth_gravity / 2, 1e-9);
    EXPECT_NEAR(run.last("ball.y"), rate / mass * std::pow(later, 3) / 6, 1e-9);
  }
}

// The end of a crank gives way in one direction alone: it comes back with e times its speed, whatever friction would
// rather stop, and slips back with it.
TEST(ContactMotion, TheEndOfACrankComesBackInSpiteOfFriction) {
  std::mt19937 engine(4);
  const auto random = [&](double from, double to) { return std::uniform_real_distribution(from, to)(engine); };
  for (int n = 0; n < 20; ++n) {
    SCOPED_TRACE(n);
    const double e = random(0.4, 0.9), mu = random(0.05, 0.6), w0 = random(1, 3), depth = random(0.05, 0.3);
    const double inertia = 0.02 + 0.2 * 0.2;
    const auto speed = [&](double angle) {
      return std::sqrt(w0 * w0 + 2 * earth_gravity * 0.2 * std::sin(angle) / inertia);
    };
    const double touch = std::asin(depth / 0.4), speed2 = speed(touch) * speed(touch);
    double time = 0;  // by the midpoint rule
    for (int k = 0; k < 1000; ++k) time += touch / 1000 / speed((k + 0.5) * touch / 1000);
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"p": {"mass": 1, "inertia": 0.02, "position": [0.2, 0],
          "angular_velocity": )" +
        text_of(-w0) + R"(, "points": {"o": [-0.2, 0], "e": [0.2, 0]}}},
        "constraints": [{"type": "revolute", "i": "ground", "j": "p.o"}],
        "forces": [{"type": "contact", "name": "C", "i": "ground", "j": "p.e", "mu": )" +
        text_of(mu) + R"(, "restitution": )" + text_of(e) + R"(, "curve": {"line": {"point": [0, )" + text_of(-depth) +
        R"(], "axis": [1, 0]}}}], "outputs": ["energy.total", "C.gap"],)" + dynamics({0, time + 0.002}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(instants(run, "impact").size(), 1u);
    const double lost = inertia * speed2 * (1 - e * e) / 2;
    EXPECT_NEAR(run.first("energy.total") - run.last("energy.total"), lost, 1e-9 * (1 + lost));
  }
}

}  // namespace
}  // namespace catena::testing
