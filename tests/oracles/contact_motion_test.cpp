// Motion with impacts, contact and dry friction against closed forms: random bodies on slopes, discs that meet, masses
// on springs that rub, blocks that slide to a stop, wheels that slip and roll, pins that rub.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81;

struct Change {
  std::string name, kind;
  double t;
};

std::vector<Change> changes_of(const TextRun& run) {
  std::vector<Change> changes;
  for (const FieldRecord& record : field<std::vector<FieldRecord>>(run, "events")) {
    Change change{"", "", 0};
    for (const auto& [key, value] : record) {
      if (key == "name") change.name = std::get<std::string>(value);
      if (key == "kind") change.kind = std::get<std::string>(value);
      if (key == "t") change.t = std::get<double>(value);
    }
    changes.push_back(change);
  }
  return changes;
}
std::vector<double> instants(const TextRun& run, const std::string& kind) {
  std::vector<double> t;
  for (const Change& change : changes_of(run)) {
    if (change.kind == kind) t.push_back(change.t);
  }
  return t;
}

/// A line through the origin that falls to the right by `slope`; free above.
std::string ground_line(double slope) {
  return R"("curve": {"line": {"point": [0,0], "axis": )" + pair_of(std::cos(slope), -std::sin(slope)) + "}}";
}
std::string dynamics(const std::vector<double>& at, double tolerance = 1e-11) {
  std::string list;
  for (double t : at) list += (list.empty() ? "" : ",") + text_of(t);
  return R"("analyses": [{"type": "dynamics", "at": [)" + list + R"(], "tolerance": )" + text_of(tolerance) + "}]}";
}

// A ball of restitution e on a slope without friction: in the slope's frame every flight is a parabola.
TEST(ContactMotion, BallsBounceDownSlopes) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double slope = random(-0.6, 0.6), e = random(0.3, 0.95), radius = random(0, 0.1), mass = random(0.1, 5);
    const double height = random(0.1, 1), along = random(-1, 1), up = random(-1, 1), s0 = random(-0.5, 0.5);
    const double c = std::cos(slope), s = std::sin(slope);
    // Across the slope: n, along it: w.
    const double n0 = height, a = g * c, b = g * s;
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
    const double fall = std::sqrt(2 * 0.95 / g), end = fall * (1 + e) / (1 - e);
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
    EXPECT_NEAR(run.last("floor.force"), 2 * g, 1e-9);
    EXPECT_NEAR(run.last("energy.dissipated"), 2 * g * 0.95, 1e-8);
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
    const double fall = std::sqrt(2 * height / g), v0 = -g * fall, rest = -g / (omega * omega);
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
    EXPECT_NEAR(run.last("ball.y"), depth + v * later - g * later * later / 2, 1e-8);
    ASSERT_EQ(instants(run, "contact").size(), 1u);
    ASSERT_EQ(instants(run, "release").size(), 1u);
    EXPECT_NEAR(instants(run, "contact")[0], fall, 1e-9);
    EXPECT_NEAR(instants(run, "release")[0], fall + b, 1e-7);
    EXPECT_TRUE(instants(run, "impact").empty());
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8 * mass);
  }
}

// A mass on a spring that rubs: every half swing is a cosine about a centre moved by mu m g / k.
TEST(ContactMotion, MassesOnSpringsRubToAStop) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double mass = random(0.5, 2), k = random(50, 200), mu = random(0.05, 0.3), x0 = random(0.2, 0.5);
    const double omega = std::sqrt(k / mass), shift = mu * mass * g / k;
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
    const double way = (rolls ? g * s / (1 + part) : g * (s - mu * c)) * t * t / 2;
    const double turn = rolls ? -way / radius : -mu * mass * g * c * radius / inertia * t * t / 2;
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
    EXPECT_NEAR(run.last("road.force"), mass * g * c, 1e-8);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  }
}

// A fast wheel in any unit of length, on which a torque grows: it rolls until friction no longer suffices, then slips.
TEST(ContactMotion, FastWheelsBeginToSlip) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double unit = std::pow(10, random(-3, 3)), speed = unit * std::pow(10, random(0, 2.5));
    const double mass = random(0.5, 20), radius = unit * random(0.1, 0.5), mu = random(0.1, 0.6);
    const double inertia = random(0.3, 1) * mass * radius * radius, slip = random(0.5, 2), t = slip + random(0.1, 1);
    // Rolling: m a = F, J a / R = k t - F R.
    const double resists = mass * radius + inertia / radius, k = mu * g * unit * resists / slip, after = t - slip;
    const double v = speed + k * slip * slip / (2 * resists), a = mu * g * unit;
    const double x = speed * slip + k * std::pow(slip, 3) / (6 * resists) + v * after + a * after * after / 2;
    const double omega = -v / radius + (mass * a * radius * after - k * (t * t - slip * slip) / 2) / inertia;
    const TextRun run =
        run_text(R"({"catena":1, "gravity":[0,)" + text_of(-g * unit) + R"(], "bodies": {"wheel": {"mass": )" +
                 text_of(mass) + R"(, "inertia": )" + text_of(inertia) + R"(, "position": )" + pair_of(0, radius) +
                 R"(, "velocity": )" + pair_of(speed, 0) + R"(, "angular_velocity": )" + text_of(-speed / radius) +
                 R"(}}, "forces": [{"type": "contact", "name": "road", "i": "ground", "j": "wheel", "mu": )" +
                 text_of(mu) + R"(, "radius": )" + text_of(radius) + "," + ground_line(0) +
                 R"(}, {"type": "torque", "i": "wheel", "torque": {"polynomial": [0, )" + text_of(-k) +
                 R"(]}}], "outputs": ["wheel.x", "wheel.y", "wheel.vx", "wheel.omega"],)" + dynamics({t}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<Change> changes = changes_of(run);
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
    const double c = std::cos(slope), s = std::sin(slope), a = g * (mu * c - s), stop = speed / a;
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
    const double sum = mass * g * c, tip = mu * sum * h / 0.1;
    EXPECT_NEAR(run.first("l.force"), (sum - tip) / 2, 1e-7);
    EXPECT_NEAR(run.first("r.force"), (sum + tip) / 2, 1e-7);
  }
}

// A flywheel whose pin rubs loses speed evenly.
TEST(ContactMotion, PinsRubWheelsToAStop) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double mass = random(1, 20), inertia = random(0.1, 2), mu = random(0.05, 0.3), radius = random(0.005, 0.05);
    const double omega = random(-20, 20), slowing = mu * mass * g * radius / inertia, stop = std::abs(omega) / slowing;
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
    EXPECT_NEAR(run.first("rub.friction"), -std::copysign(mu * mass * g * radius, omega), 1e-9);
    EXPECT_NEAR(run.last("wheel.angle"), omega * stop / 2, 1e-8 * std::abs(omega * stop));
    EXPECT_NEAR(run.last("wheel.omega"), 0, 1e-10);
    EXPECT_NEAR(run.last("energy.dissipated"), inertia * omega * omega / 2, 1e-8 * inertia * omega * omega);
  }
}

// A block that a belt carries along: it comes loose where the spring pulls mu_static N, slips, and sticks again where
// it has the belt's speed; over and over, at instants in closed form.
TEST(ContactMotion, BlocksStickAndSlipOnBelts) {
  for (unsigned seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double mass = random(0.5, 2), k = random(30, 150), mu = random(0.1, 0.3),
                 more = seed % 5 == 0 ? 1 : random(1.1, 2);
    const double speed = random(0.05, 0.4), omega = std::sqrt(k / mass), centre = mu * mass * g / k;
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

// A mass that rests on a stop is lifted by a growing force: it leaves where that is its weight.
TEST(ContactMotion, StopsLetGo) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    // m y'' = f t - m g from t = m g / f on.
    const double mass = random(0.5, 3), rate = random(5, 40), leave = mass * g / rate, later = random(0.1, 0.5);
    const double end = leave + later;
    const TextRun run = run_text(
        R"({"catena":1, "gravity":[0,-9.81], "bodies": {"ball": {"particle": true, "mass": )" + text_of(mass) +
        R"(}}, "constraints": [{"type": "absolute_x", "i": "ball", "value": 0}], "forces": [{"type": "stop", "name": "bed",
        "column": "ball.y", "min": 0}, {"type": "point_force", "i": "ball", "force": [0, {"polynomial": [0, )" +
        text_of(rate) + R"(]}]}], "outputs": ["ball.y", "bed.force"],)" + dynamics({leave / 2, end}));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(instants(run, "release").size(), 1u);
    EXPECT_NEAR(instants(run, "release")[0], leave, 1e-9);
    EXPECT_NEAR(run.first("bed.force"), mass * g / 2, 1e-9);
    EXPECT_NEAR(run.last("ball.y"), rate / mass * std::pow(later, 3) / 6, 1e-9);
  }
}

const std::string wave = R"("curve": {"spline": {"points": [[-1, 0.2], [-0.3, 0.1], [0.3, -0.05], [0.8, 0.1], [2, 0.2]],
  "end": "natural"}})";

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
    EXPECT_NEAR(1.5 * (run.column("b.ay")[k] + g), run.column("f.fy")[k], 1e-10) << k;
    EXPECT_NEAR(run.column("f.slip")[k], std::hypot(run.column("b.vx")[k], run.column("b.vy")[k]), 1e-10) << k;
  }
}

// Steps of order 5 end with the state that their last stage was evaluated at: nothing is stiff there.
TEST(ContactMotion, DigitsAreClaimedOnASplineByOrderFive) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"particle": true, "mass": 1,
    "position": [-0.3, 0.1]}}, "constraints": [{"type": "point_on_curve", "i": "ground", "j": "b", )" +
                               wave + R"(}], "outputs": ["b.x"],
    "analyses": [{"type": "dynamics", "method": "rk5", "until": 1, "every": 0.5}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  ASSERT_FALSE(run.analysis().digits.empty());
  for (const double digits : run.analysis().digits) EXPECT_GT(digits, 4);
}

}  // namespace
}  // namespace catena::testing
