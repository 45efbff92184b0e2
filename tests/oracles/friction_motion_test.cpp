// Motion with dry friction against closed forms: masses on springs that rub, blocks that slide to a stop, wheels that
// slip and roll, pins that rub, splines with their knots and ends.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/contact_runs.hpp"

namespace catena::testing {
namespace {

const std::string wave = R"("curve": {"spline": {"points": [[-1, 0.2], [-0.3, 0.1], [0.3, -0.05], [0.8, 0.1], [2, 0.2]],
  "end": "natural"}})";

// A mass on a spring that rubs: every half swing is a cosine about a centre moved by mu m g / k.
TEST(ContactMotion, MassesOnSpringsRubToAStop) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double mass = random(0.5, 2), k = random(50, 200), mu = random(0.05, 0.3), x0 = random(0.2, 0.5);
    const double omega = std::sqrt(k / mass), shift = mu * mass * earth_gravity / k;
    double x = x0;
    int halves = 0;
    while (std::abs(x) > shift) x = (x > 0 ? 2 * shift : -2 * shift) - x, ++halves;
    const double stop = halves * M_PI / omega;
    const TextRun run = run_text(
        R"({"catena":1, "gravity":[0,-9.81], "bodies": {"block": {"particle": true, "mass": )" + text_of(mass) +
        R"(, "position": )" + pair_of(x0, 0) + R"(}}, "forces": [{"type": "contact", "name": "rub", "i": "ground",
        "j": "block", "mu": )" +
        text_of(mu) + "," + ground_line(0) + R"(}, {"type": "spring_damper", "i":
        ["ground", [-1,0]], "j": "block", "length": 1, "k": )" +
        text_of(k) + R"(}],
        "outputs": ["block.x", "block.vx", "energy.balance"],)" +
        dynamics({stop / 2, stop + 1}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_FALSE(instants(run, "stick").empty());
    EXPECT_NEAR(instants(run, "stick").back(), stop, 1e-9);
    EXPECT_NEAR(run.last("block.x"), x, 1e-9);
    EXPECT_NEAR(run.last("block.vx"), 0, 1e-12);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// A wheel on a slope: it rolls where friction suffices, else it slips from the start.
TEST(ContactMotion, WheelsRollOrSlipDownSlopes) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double slope = random(0.05, 0.7), mass = random(0.5, 4), radius = random(0.05, 0.3), mu = random(0.02, 0.5);
    const double part = random(0.3, 1), inertia = part * mass * radius * radius, t = 1;
    const double c = std::cos(slope), s = std::sin(slope);
    const bool rolls = s / (1 + 1 / part) <= mu * c;
    const double way = (rolls ? earth_gravity * s / (1 + part) : earth_gravity * (s - mu * c)) * t * t / 2;
    const double turn = rolls ? -way / radius : -mu * mass * earth_gravity * c * radius / inertia * t * t / 2;
    const TextRun run = run_text(
        R"({"catena":1, "gravity":[0,-9.81], "bodies": {"wheel": {"mass": )" + text_of(mass) + R"(, "inertia": )" +
        text_of(inertia) + R"(, "position": )" + pair_of(radius * s, radius * c) + R"(}}, "forces": [{"type": "contact",
        "name": "road", "i": "ground", "j": "wheel", "mu": )" +
        text_of(mu) + R"(, "radius": )" + text_of(radius) + "," + ground_line(slope) +
        R"(}], "outputs": ["wheel.x", "wheel.y", "wheel.angle", "road.force", "energy.balance"],)" + dynamics({t}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(run.last("wheel.x"), radius * s + way * c, 1e-9);
    EXPECT_NEAR(run.last("wheel.y"), radius * c - way * s, 1e-9);
    EXPECT_NEAR(run.last("wheel.angle"), turn, 1e-8);
    EXPECT_NEAR(run.last("road.force"), mass * earth_gravity * c, 1e-8);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// A fast wheel in any unit of length, on which a torque grows: it rolls until friction no longer suffices, then slips.
TEST(ContactMotion, FastWheelsBeginToSlip) {
  for (unsigned seed = 1; seed <= size_of_test(40u, 12u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double unit = std::pow(10, random(-3, 3)), speed = unit * std::pow(10, random(0, 2.5));
    const double mass = random(0.5, 20), radius = unit * random(0.1, 0.5), mu = random(0.1, 0.6);
    const double inertia = random(0.3, 1) * mass * radius * radius, slip = random(0.5, 2), t = slip + random(0.1, 1);
    // Rolling: m a = F, J a / R = k t - F R.
    const double resists = mass * radius + inertia / radius, k = mu * earth_gravity * unit * resists / slip,
                 after = t - slip;
    const double v = speed + k * slip * slip / (2 * resists), a = mu * earth_gravity * unit;
    const double x = speed * slip + k * std::pow(slip, 3) / (6 * resists) + v * after + a * after * after / 2;
    const double omega = -v / radius + (mass * a * radius * after - k * (t * t - slip * slip) / 2) / inertia;
    const TextRun run = run_text(
        R"({"catena":1, "gravity":[0,)" + text_of(-earth_gravity * unit) + R"(], "bodies": {"wheel": {"mass": )" +
        text_of(mass) + R"(, "inertia": )" + text_of(inertia) + R"(, "position": )" + pair_of(0, radius) +
        R"(, "velocity": )" + pair_of(speed, 0) + R"(, "angular_velocity": )" + text_of(-speed / radius) +
        R"(}}, "forces": [{"type": "contact", "name": "road", "i": "ground", "j": "wheel", "mu": )" + text_of(mu) +
        R"(, "radius": )" + text_of(radius) + "," + ground_line(0) +
        R"(}, {"type": "torque", "i": "wheel", "torque": {"polynomial": [0, )" + text_of(-k) +
        R"(]}}], "outputs": ["wheel.x", "wheel.y", "wheel.vx", "wheel.omega"],)" + dynamics({t}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<EventEntry> changes = events_of(run);
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].kind, "slip");
    EXPECT_NEAR(changes[0].t, slip, 1e-9);
    EXPECT_NEAR(run.last("wheel.x"), x, 1e-10 * speed * t);
    EXPECT_NEAR(run.last("wheel.y"), radius, 1e-12 * radius);
    EXPECT_NEAR(run.last("wheel.vx"), v + a * after, 1e-10 * v);
    EXPECT_NEAR(run.last("wheel.omega"), omega, 1e-9 * std::abs(omega));
  }
}

// A block on two corners that slides up a slope: it stops, and stays where friction holds it.
TEST(ContactMotion, BlocksSlideToAStop) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double slope = random(-0.3, -0.02), mu = random(0.35, 0.6), speed = random(0.5, 2), mass = random(0.5, 3);
    const double c = std::cos(slope), s = std::sin(slope), a = earth_gravity * (mu * c - s), stop = speed / a;
    const double w = speed * speed / (2 * a), h = 0.03;
    const TextRun run = run_text(R"({"catena":1, "gravity":[0,-9.81], "bodies": {"block": {"mass": )" + text_of(mass) +
                                 R"(, "inertia": 0.01, "angle": )" + text_of(-slope) + R"(, "position": )" +
                                 pair_of(h * s, h * c) + R"(, "velocity": )" + pair_of(speed * c, -speed * s) +
                                 R"(, "points": {"l": [-0.1,-0.03], "r": [0.1,-0.03]}}},
        "forces": [{"type": "contact", "name": "l", "i": "ground", "j": "block.l", "mu": )" +
                                 text_of(mu) + "," + ground_line(slope) +
                                 R"(}, {"type": "contact", "name": "r", "i": "ground", "j": "block.r", "mu": )" +
                                 text_of(mu) + "," + ground_line(slope) +
                                 R"(}], "outputs": ["block.x", "block.y", "block.angle", "l.force",
        "r.force"],)" + dynamics({stop / 2, stop + 1}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_FALSE(instants(run, "stick").empty());
    EXPECT_NEAR(instants(run, "stick").front(), stop, 1e-9);
    EXPECT_NEAR(run.last("block.x"), h * s + w * c, 1e-8);
    EXPECT_NEAR(run.last("block.y"), h * c - w * s, 1e-8);
    EXPECT_NEAR(run.last("block.angle"), -slope, 1e-10);
    // While it slides friction at the bottom tips it forwards: r carries more than l.
    const double sum = mass * earth_gravity * c, tip = mu * sum * h / 0.1;
    EXPECT_NEAR(run.first("l.force"), (sum - tip) / 2, 1e-7);
    EXPECT_NEAR(run.first("r.force"), (sum + tip) / 2, 1e-7);
  }
}

// A flywheel whose pin rubs loses speed evenly.
TEST(ContactMotion, PinsRubWheelsToAStop) {
  for (unsigned seed = 1; seed <= size_of_test(20u, 8u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double mass = random(1, 20), inertia = random(0.1, 2), mu = random(0.05, 0.3), radius = random(0.005, 0.05);
    const double omega = random(-20, 20), slowing = mu * mass * earth_gravity * radius / inertia,
                 stop = std::abs(omega) / slowing;
    const TextRun run = run_text(R"({"catena":1, "gravity":[0,-9.81], "bodies": {"wheel": {"mass": )" + text_of(mass) +
                                 R"(, "inertia": )" + text_of(inertia) + R"(, "angular_velocity": )" + text_of(omega) +
                                 R"(}}, "constraints": [{"type": "revolute",
        "name": "pin", "i": "ground", "j": "wheel"}], "forces": [{"type": "friction", "name": "rub", "joint": "pin",
        "mu": )" + text_of(mu) + R"(, "radius": )" +
                                 text_of(radius) + R"(}], "outputs": ["wheel.angle", "wheel.omega",
        "rub.friction", "energy.dissipated"],)" +
                                 dynamics({stop / 2, stop + 1}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(instants(run, "stick").size(), 1u);
    EXPECT_NEAR(instants(run, "stick")[0], stop, 1e-9 * stop);
    EXPECT_NEAR(run.first("rub.friction"), -std::copysign(mu * mass * earth_gravity * radius, omega), 1e-9);
    EXPECT_NEAR(run.last("wheel.angle"), omega * stop / 2, 1e-8 * std::abs(omega * stop));
    EXPECT_NEAR(run.last("wheel.omega"), 0, 1e-10);
    EXPECT_NEAR(run.last("energy.dissipated"), inertia * omega * omega / 2, 1e-8 * inertia * omega * omega);
  }
}

// A block that a belt carries along: it comes loose where the spring pulls mu_static N, slips, and sticks again where
// it has the belt's speed; over and over, at instants in closed form.
TEST(ContactMotion, BlocksStickAndSlipOnBelts) {
  for (unsigned seed = 1; seed <= size_of_test(25u, 10u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double mass = random(0.5, 2), k = random(30, 150), mu = random(0.1, 0.3),
                 more = seed % 5 == 0 ? 1 : random(1.1, 2);
    const double speed = random(0.05, 0.4), omega = std::sqrt(k / mass), centre = mu * mass * earth_gravity / k;
    const double loose = more * centre, first = loose / speed;
    const double angle = 2 * M_PI - 2 * std::atan((loose - centre) * omega / speed);
    const double second = first + angle / omega, stuck_at = 2 * centre - loose,
                 third = second + (loose - stuck_at) / speed;
    const bool sticks = more > 1;
    const double end = third + 0.3 / omega;
    const TextRun run = run_text(
        R"({"catena":1, "gravity":[0,-9.81], "bodies": {"belt": {"mass": 1, "inertia": 1, "velocity": )" +
        pair_of(speed, 0) + R"(}, "block": {"particle": true, "mass": )" + text_of(mass) + R"(, "velocity": )" +
        pair_of(speed, 0) + R"(}}, "constraints": [{"type": "absolute_y", "i": "belt", "value": 0},
        {"type": "absolute_angle", "i": "belt", "value": 0}], "drivers": [{"type": "absolute_x", "i": "belt",
        "value": {"polynomial": [0, )" +
        text_of(speed) + R"(]}}], "forces": [{"type": "contact", "name": "rub",
        "i": "belt", "j": "block", "mu": )" +
        text_of(mu) + R"(, "mu_static": )" + text_of(more * mu) + "," + ground_line(0) +
        R"(}, {"type": "spring_damper", "i": ["ground", [-1,0]], "j": "block", "length": 1, "k": )" + text_of(k) +
        R"(}], "outputs": ["block.x", "energy.balance"],)" + dynamics({end}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_FALSE(instants(run, "slip").empty());
    EXPECT_NEAR(instants(run, "slip")[0], first, 1e-9);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
    if (!sticks) continue;
    ASSERT_FALSE(instants(run, "stick").empty());
    EXPECT_NEAR(instants(run, "stick")[0], second, 1e-8);
    ASSERT_GE(instants(run, "slip").size(), 2u);
    EXPECT_NEAR(instants(run, "slip")[1], third, 1e-8);
    const double later = end - third;
    EXPECT_NEAR(run.last("block.x"),
                centre + (loose - centre) * std::cos(omega * later) + speed / omega * std::sin(omega * later), 1e-8);
  }
}

// Friction on a spline, whose third derivative jumps at its knots: what is shown of it moves the particle.
TEST(ContactMotion, FrictionPassesTheKnotsOfASpline) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"particle": true, "mass": 1.5,
    "position": [-0.3, 0.1], "velocity": [1.4389073467301179, -0.42372827086010195]}},
    "forces": [{"type": "contact", "name": "f", "i": "ground", "j": "b", "mu": 0.1, )" +
                               wave + R"(}], "outputs": ["b", "f.fx", "f.fy", "f.slip"], )" +
                               dynamics({0.1, 0.2, 0.3, 0.35, 0.4, 0.5}));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(1.5 * run.column("b.ax")[k], run.column("f.fx")[k], 1e-10) << k;
    EXPECT_NEAR(1.5 * (run.column("b.ay")[k] + earth_gravity), run.column("f.fy")[k], 1e-10) << k;
    const double vx = run.column("b.vx")[k], vy = run.column("b.vy")[k], v = std::hypot(vx, vy);
    EXPECT_NEAR(run.column("f.slip")[k], v, 1e-10) << k;
    // Coulomb: against the velocity, a tenth of what presses across it.
    const double fx = run.column("f.fx")[k], fy = run.column("f.fy")[k], across = std::abs(fx * vy - fy * vx) / v;
    EXPECT_GT(across, 1) << k;
    EXPECT_NEAR((fx * vx + fy * vy) / v, -0.1 * across, 1e-9) << k;
  }
}

// Off the end of a spline that goes on as a line: there the slope, and with it the acceleration, stays as it is.
TEST(ContactMotion, FrictionGoesOnBeyondTheEndOfASpline) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"particle": true, "mass": 1.5,
    "position": [-0.5, 0.3], "velocity": [0.3, -0.2]}}, "forces": [{"type": "contact", "name": "f", "i": "ground", "j": "b",
    "mu": 0.1, "curve": {"spline": {"points": [[-1, 0.5], [-0.5, 0.3], [0, 0.05], [0.3, -0.2]], "end": "natural",
    "beyond": "line"}}}], "outputs": ["b", "f.slip", "f.force"], )" +
                               dynamics({0.7, 0.8, 0.9}));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_GT(run.column("b.x")[k], 0.3);
    const double vx = run.column("b.vx")[k], vy = run.column("b.vy")[k], v = std::hypot(vx, vy);
    EXPECT_NEAR(run.column("f.slip")[k], v, 1e-10) << k;
    EXPECT_NEAR(run.column("f.force")[k], 1.5 * earth_gravity * vx / v, 1e-8) << k;
    EXPECT_NEAR((run.column("b.ax")[k] * vx + run.column("b.ay")[k] * vy) / v, -earth_gravity * (vy + 0.1 * vx) / v,
                1e-8)
        << k;
    EXPECT_NEAR(vy / vx, run.column("b.vy")[0] / run.column("b.vx")[0], 1e-9) << k;
  }
}

// Ever smaller bounces end on the stop at the instant at which the pin begins to stick: both hold the one angle then,
// at the stop.
TEST(ContactMotion, ALeverRestsOnItsStopWhereItsPinBeginsToStick) {
  constexpr double end = 0.05817529584125922;
  const auto lever = [&](const std::string& options) {
    return run_text(R"({"catena": 1, "gravity": [1.753264401870085, -6.815149903504329], "bodies": {"b": {
        "mass": 0.9802184712910531, "inertia": 0.12686552351749872, "position": [-0.31578045896751744,
        -0.28484590129934995]}},
      "constraints": [{"type": "revolute", "name": "J", "i": "ground", "j": ["b", [0.31578045896751744,
        0.28484590129934995]], "c": 0.23717959832676389}],
      "forces": [{"type": "stop", "name": "rest", "column": "J.angle", "min": -0.5366972978923161, "max": )" +
                    text_of(end) + R"(, "restitution": 0.8}, {"type": "friction", "name": "rub", "joint": "J",
        "mu": 0.2718668404889413, "radius": 0.08295947719018418}],
      "outputs": ["b.angle", "b.omega"], "analyses": [{"type": "dynamics", "until": 1)" +
                    options + "}]}");
  };
  for (const std::string method : {"auto", "rk5", "adams", "radau"}) {
    for (const std::string tolerance : {"1e-6", "1e-8", "1e-10"}) {
      SCOPED_TRACE(method + " " + tolerance);
      const TextRun run = lever(R"(, "method": ")" + method + R"(", "tolerance": )" + tolerance);
      ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message << run.outcome.error_text;
      EXPECT_NEAR(run.last("b.angle"), end, 1e-14);
      EXPECT_NEAR(run.last("b.omega"), 0, 1e-14);
    }
  }
}

// A lever that its pin would hold alone hangs on a cable as well: it rests, and pin and cable share its load within
// their limits.
TEST(ContactMotion, APinAndACableShareALoad) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"mass": 1, "rod": {
      "from": [0, 0], "to": [1, 0]}}},
    "constraints": [{"type": "revolute", "name": "J", "i": "ground", "j": "b.from"}],
    "forces": [{"type": "friction", "name": "rub", "joint": "J", "mu": 0.5, "radius": 2},
               {"type": "cable", "name": "rope", "i": ["ground", [1, 2]], "j": "b.to", "length": 2}],
    "outputs": ["b.angle", "rope.force", "rub.friction", "J.fy"], "analyses": [{"type": "dynamics", "until": 1}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.last("b.angle"), 0, 1e-12);
  const double rope = run.last("rope.force"), moment = run.last("rub.friction");
  EXPECT_GE(rope, 0);
  EXPECT_NEAR(rope + moment, 9.81 / 2, 1e-9);
  EXPECT_LE(std::abs(moment), 0.5 * 2 * (9.81 - rope) * (1 + 1e-9));
}

}  // namespace
}  // namespace catena::testing
