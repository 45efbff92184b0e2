// Velocities that jump: drivers whose speed does, constraints that are engaged, blows; with what constraints exert
// then.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

std::string number(double value) { return fmt::format("{:.17g}", value); }

/// v1 t until 0.4 s, with the speed v2 from there on: a line and a table of two points that is held beyond its end.
std::string kinked(double v1, double v2) {
  return R"({"sum": [{"polynomial": [0, )" + number(v2) + R"(]}, {"spline": {"t": [0, 0.4], "value": [0, )" +
         number(0.4 * (v1 - v2)) + R"(], "beyond": "hold"}}]})";
}

// A rod on a pin, turned at 2 and then at 5 rad/s: J dw about the pin, and m dv of its centre by the pin.
TEST(Jolts, OfADrivenRod) {
  const double m = 3, length = 0.8, inertia = 0.25, about = inertia + m * length * length / 4, dw = 3;
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"rod": {"mass": 3, "inertia": 0.25, "position": [0.4, 0]}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": ["rod", [-0.4, 0]]}],
    "drivers": [{"type": "relative_angle", "name": "motor", "i": "ground", "j": "rod", "value": )" +
                               kinked(2, 5) + R"(}],
    "outputs": ["rod.omega", "motor.work", "energy.balance"],
    "analyses": [{"type": "dynamics", "at": [0.1, 0.39, 0.41, 0.6], "tolerance": 1e-11}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.first("rod.omega"), 2, 1e-12);
  EXPECT_NEAR(run.last("rod.omega"), 5, 1e-12);
  EXPECT_NEAR(run.last("motor.work"), about * (25 - 4) / 2, 1e-10);
  for (const double balance : run.column("energy.balance")) EXPECT_NEAR(balance, 0, 1e-10);
  const std::vector<EventEntry> events = events_of(run);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].name, "motor");
  EXPECT_EQ(events[0].kind, "jump");
  EXPECT_NEAR(events[0].t, 0.4, 1e-15);
  ASSERT_EQ(impulses_of(run).size(), 2U);
  const ImpulseEntry motor = impulse_of(run, "motor"), pin = impulse_of(run, "pin");
  EXPECT_EQ(motor.event, "motor");
  EXPECT_NEAR(motor.load, about * dw, 1e-11);
  EXPECT_NEAR(motor.moment, about * dw, 1e-11);
  EXPECT_NEAR(motor.px, 0, 1e-11);
  const double angle = 0.8;
  EXPECT_NEAR(pin.px, -m * dw * length / 2 * std::sin(angle), 1e-11);
  EXPECT_NEAR(pin.py, m * dw * length / 2 * std::cos(angle), 1e-11);
  EXPECT_NEAR(pin.moment, 0, 1e-11);
  EXPECT_TRUE(std::isnan(pin.load));
}

// A distance that is driven has squared equations: its load is in N s all the same. Two rods share what one would take.
TEST(Jolts, OfDistancesAndOfRedundantDrivers) {
  const std::string one = R"({"type": "absolute_distance", "name": "ram", "i": "a", "ground": [-1, 0], "value": )" +
                          std::string(R"({"sum": [1, )") + kinked(0.5, -1) + "]}}";
  const auto scene = [](const std::string& drivers) {
    return R"({"catena": 1, "bodies": {"a": {"mass": 4, "particle": true}},
      "constraints": [{"type": "absolute_y", "i": "a", "value": 0}], "drivers": [)" +
           drivers + R"(], "analyses": [{"type": "dynamics", "until": 0.6, "outputs": ["a.vx"]}]})";
  };
  const TextRun alone = run_text(scene(one));
  ASSERT_EQ(alone.outcome.exit_code, 0) << alone.outcome.error_text << alone.analysis().report.message;
  EXPECT_NEAR(impulse_of(alone, "ram").load, 4 * -1.5, 1e-9);
  EXPECT_NEAR(impulse_of(alone, "ram").px, 4 * -1.5, 1e-9);
  const TextRun both =
      run_text(scene(one + R"(, {"type": "absolute_x", "name": "twin", "i": "a", "value": )" + kinked(0.5, -1) + "}"));
  ASSERT_EQ(both.outcome.exit_code, 0) << both.outcome.error_text << both.analysis().report.message;
  EXPECT_EQ(events_of(both).size(), 2U) << "both drivers jump";
  EXPECT_NEAR(impulse_of(both, "ram").load, -3, 1e-9);
  EXPECT_NEAR(impulse_of(both, "twin").load, -3, 1e-9);
}

// Motions that begin and end smoothly, and tables, do not jump.
TEST(Jolts, SmoothDriversHaveNone) {
  for (const std::string value :
       {R"({"step": {"t0": 0.2, "t1": 0.5, "from": 0, "to": 2, "order": 3}})",
        R"({"step": {"t0": 0.2, "t1": 0.5, "from": 0, "to": 2}})",
        R"({"law": {"type": "modified_trapezoid", "t0": 0.1, "t1": 0.7, "from": 0, "to": 1}})",
        R"({"spline": {"t": [0, 0.2, 0.3, 0.7, 1], "value": [0, 1, 0, 2, 1], "end": "clamped"}})",
        R"({"spline": {"t": [0, 0.05, 0.1, 0.2], "value": [0, 1, 0.5, 0], "end": "periodic"}})",
        R"({"spline": {"t": [0, 0.2], "value": [0, 1], "beyond": "line"}})"}) {
    const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {"mass": 4, "inertia": 1}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a"}],
      "drivers": [{"type": "absolute_angle", "i": "a", "value": )" +
                                 value + R"(}], "analyses": [{"type": "dynamics", "until": 1}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_TRUE(events_of(run).empty()) << value;
    EXPECT_TRUE(impulses_of(run).empty()) << value;
  }
}

// Carriages that couple: p = m1 m2 / (m1 + m2) (v1 - v2), told of the coupling; the rails take none.
TEST(Jolts, OfAnEngagedCoupling) {
  // Also beside a contact, which decides about velocities then.
  const std::string wall = R"(, "forces": [{"type": "contact", "name": "wall", "i": "ground", "j": "b",
    "curve": {"line": {"point": [100, 0], "axis": [0, 1]}}}])";
  for (const std::string& forces : {std::string(), wall}) {
    const TextRun run = run_text(R"({"catena": 1,
      "bodies": {"a": {"mass": 3, "inertia": 1, "velocity": [2, 0]},
                 "b": {"mass": 1, "inertia": 1, "position": [4, 0]}},
      "constraints": [{"type": "translational", "i": "ground", "j": "a", "axis_i": [1, 0], "axis_j": [1, 0]},
                      {"type": "translational", "i": "ground", "j": "b", "axis_i": [1, 0], "axis_j": [1, 0]},
                      {"type": "relative_distance", "name": "coupling", "i": "a", "j": "b", "value": 1}])" +
                                 forces +
                                 R"(, "analyses": [{"type": "dynamics", "until": 3, "every": 0.5, "outputs": ["b.vx"],
      "events": [{"name": "meet", "when": "coupling.value", "value": 1, "direction": "down",
                  "action": "engage", "element": "coupling"}]}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    ASSERT_EQ(impulses_of(run).size(), 1U);
    const ImpulseEntry coupling = impulse_of(run, "coupling");
    EXPECT_EQ(coupling.event, "meet");
    EXPECT_NEAR(coupling.t, 1.5, 1e-9);
    EXPECT_NEAR(coupling.px, 3. / 4 * 2, 1e-9);
    EXPECT_NEAR(coupling.py, 0, 1e-9);
    EXPECT_NEAR(run.last("b.vx"), 1.5, 1e-9);
  }
}

// A clutch that takes a wheel along: of a joint it has a moment.
TEST(Jolts, OfAnEngagedClutch) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"a": {"mass": 1, "inertia": 0.3, "angular_velocity": 10}, "b": {"mass": 1, "inertia": 0.2}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a"}, {"type": "revolute", "i": "ground", "j": "b"},
                    {"type": "relative_angle", "name": "clutch", "i": "a", "j": "b"}],
    "analyses": [{"type": "dynamics", "until": 2, "every": 0.5, "outputs": ["b.omega"],
      "events": [{"name": "close", "when": "a.angle", "value": "=4*pi", "action": "engage", "element": "clutch"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.last("b.omega"), 6, 1e-9);
  EXPECT_NEAR(impulse_of(run, "clutch").moment, 0.2 * 6, 1e-9);
  EXPECT_EQ(impulses_of(run).size(), 1U);
}

// A rod that is struck at its end: the pin takes m w l / 2 - P, half of P for a slender one.
TEST(Jolts, OfAPinWhoseRodIsStruck) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"rod": {"mass": 2, "rod": {"from": [0, 0], "to": [0, -0.6]}}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],
    "analyses": [{"type": "dynamics", "until": 0.2, "outputs": ["rod.omega"],
      "events": [{"name": "blow", "when": "t", "value": 0.1, "impulse": {"i": "rod.to", "value": [5, 7]}}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const ImpulseEntry pin = impulse_of(run, "pin");
  EXPECT_EQ(pin.event, "blow");
  EXPECT_NEAR(pin.px, 2.5, 1e-10);
  EXPECT_NEAR(pin.py, -7, 1e-10);
  EXPECT_NEAR(run.last("rod.omega"), 5 * 0.6 / (2 * 0.36 / 3), 1e-9);
}

// A block that lies on a floor and is moved: what a motor takes where contacts hold.
TEST(Jolts, WhereContactsHold) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
    "bodies": {"block": {"particle": true, "mass": 2}},
    "drivers": [{"type": "absolute_x", "name": "push", "i": "block", "value": )" +
                               kinked(1, 3) + R"(}],
    "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "block",
                "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
    "analyses": [{"type": "dynamics", "until": 1,
                  "outputs": ["block.vx", "block.y", "push.work", "energy.balance", "energy.dissipated"]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(run.last("block.vx"), 3, 1e-10);
  EXPECT_NEAR(run.last("block.y"), 0, 1e-10);
  EXPECT_NEAR(run.last("push.work"), 9 - 1, 1e-8);
  EXPECT_NEAR(run.last("energy.balance"), 0, 1e-8);
  EXPECT_NEAR(run.last("energy.dissipated"), 0, 1e-8);
  EXPECT_NEAR(impulse_of(run, "push").load, 2 * 2, 1e-9);
  ASSERT_EQ(events_of(run).size(), 1U);
  EXPECT_EQ(events_of(run)[0].kind, "jump");
}

// Mechanisms that are integrated apart, each with its own.
TEST(Jolts, OfMechanismsApart) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"slow": {"mass": 4, "inertia": 0.5},
               "ball": {"mass": 0.01, "position": [0.02, 0], "particle": true}},
    "constraints": [{"type": "absolute_distance", "name": "link", "i": "ball", "ground": [0, 0], "value": 0.02},
                    {"type": "revolute", "name": "pin", "i": "ground", "j": "slow"}],
    "drivers": [{"type": "absolute_angle", "name": "motor", "i": "slow", "value": )" +
                               kinked(1, 3) + R"(}],
    "forces": [{"type": "spring_damper", "i": ["ground", [0.03, 0.01]], "j": "ball", "k": 4000, "length": 0.005}],
    "analyses": [{"type": "dynamics", "until": 1, "outputs": ["slow.omega"]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_EQ(field<std::int64_t>(run, "integrated_apart"), 2);
  ASSERT_EQ(impulses_of(run).size(), 1U);
  EXPECT_NEAR(impulse_of(run, "motor").load, 0.5 * 2, 1e-10);
}

// Two rods in a chain, the first of them driven: against the momentum balance of the double pendulum.
class RandomJolts : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomJolts, OfADoublePendulum) {
  std::mt19937 random(GetParam());
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const double m1 = draw(0.5, 4), m2 = draw(0.5, 4), l1 = draw(0.3, 1.5), l2 = draw(0.3, 1.5);
  const double v1 = draw(-3, 3), v2 = draw(-3, 3), a2 = draw(-2, 2);
  const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
    "bodies": {{"a": {{"mass": {0}, "rod": {{"from": [0, 0], "to": [{2}, 0]}}}},
               "b": {{"mass": {1}, "rod": {{"from": [{2}, 0], "to": [{3}, {4}]}}}}}},
    "constraints": [{{"type": "revolute", "name": "A", "i": "ground", "j": "a.from"}},
                    {{"type": "revolute", "name": "B", "i": "a.to", "j": "b.from"}}],
    "drivers": [{{"type": "absolute_angle", "name": "motor", "i": "a", "value": {5}}}],
    "analyses": [{{"type": "dynamics", "at": [0.3999999999, 0.4, 0.5], "tolerance": 1e-11,
                  "outputs": ["a.angle", "b.angle", "a.omega", "b.omega"]}}]}})",
                                           number(m1), number(m2), number(l1), number(l1 + l2 * std::cos(a2)),
                                           number(l2 * std::sin(a2)), kinked(v1, v2)));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const double th1 = run.column("a.angle")[1], th2 = run.column("b.angle")[1],
               c = m2 * l1 * l2 / 2 * std::cos(th2 - th1);
  const double dw1 = v2 - v1, dw2 = -c * dw1 / (m2 * l2 * l2 / 3);
  EXPECT_NEAR(run.column("b.omega")[1] - run.column("b.omega")[0], dw2, 1e-7);
  const double load = (m1 / 3 + m2) * l1 * l1 * dw1 + c * dw2;
  EXPECT_NEAR(impulse_of(run, "motor").load, load, 1e-9 * (1 + std::abs(load)));
  const double ux = l1 * dw1 * -std::sin(th1), uy = l1 * dw1 * std::cos(th1);  // of the joint between them
  const double bx = m2 * (ux - l2 / 2 * dw2 * std::sin(th2)), by = m2 * (uy + l2 / 2 * dw2 * std::cos(th2));
  EXPECT_NEAR(impulse_of(run, "B").px, bx, 1e-9 * (1 + std::abs(bx)));
  EXPECT_NEAR(impulse_of(run, "B").py, by, 1e-9 * (1 + std::abs(by)));
  EXPECT_NEAR(impulse_of(run, "A").px, bx + m1 * ux / 2, 1e-9 * (1 + std::abs(bx)));
  EXPECT_NEAR(impulse_of(run, "A").py, by + m1 * uy / 2, 1e-9 * (1 + std::abs(by)));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomJolts, ::testing::Range(1U, 26U));

}  // namespace
}  // namespace catena::testing
