// Rows of dynamics: at which instants there are any, and what is in them where something happened before.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/sanitized.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string spinning(const std::string& at) {
  return R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 2}},
    "forces": [{"type": "torque", "i": "b", "torque": 3}],
    "analyses": [{"type": "dynamics", "at": )" +
         at + R"(, "outputs": ["b.omega"]}]})";
}

TEST(DynamicsRows, InstantsAreListedInTheOrderOfTime) {
  const TextRun right = run_text(spinning("[0.5, 0.5, 1, 3]"));
  ASSERT_EQ(right.outcome.exit_code, 0) << right.outcome.error_text;
  EXPECT_EQ(right.column("t"), (std::vector<double>{0.5, 0.5, 1, 3}));
  EXPECT_NEAR(right.last("b.omega"), 4.5, 1e-12);

  const TextRun wrong = run_text(spinning("[0.5, 3, 1]"));
  EXPECT_EQ(wrong.outcome.exit_code, 1);
  EXPECT_EQ(wrong.analysis().report.status, Status::refused);
  EXPECT_NE(wrong.analysis().report.message.find("\"at\" must list its instants in the order of time"),
            std::string::npos)
      << wrong.analysis().report.message;
  EXPECT_NE(wrong.analysis().report.message.find("1 s comes after 3 s"), std::string::npos);

  const TextRun before = run_text(spinning("[-1, 1]"));
  EXPECT_EQ(before.outcome.exit_code, 1);
  EXPECT_NE(before.analysis().report.message.find("asked for at t = -1 s, but the motion starts at 0 s"),
            std::string::npos)
      << before.analysis().report.message;
}

// x = 2 t^2: the driver pushes 2 kg with 8 N until t = 1.5 s, 4.5 m: 36 J. Released, it does no more work.
TEST(DynamicsRows, TheWorkOfAReleasedDriverStaysWhatItWas) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
    "constraints": [{"type": "absolute_y", "i": "b", "value": 0}, {"type": "absolute_angle", "i": "b", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "D", "i": "b", "value": {"polynomial": [0, 0, 2]}}],
    "analyses": [{"type": "dynamics", "until": 3, "every": 0.5, "tolerance": 1e-11,
      "outputs": ["D.work", "D.power", "energy.balance"],
      "events": [{"when": "t", "value": 1.5, "action": "release", "element": "D"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> t = run.column("t"), work = run.column("D.work"), balance = run.column("energy.balance");
  ASSERT_EQ(t.size(), 7u);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(work[k], t[k] < 1.5 ? 16 * t[k] * t[k] : 36, 1e-9) << t[k];
    EXPECT_NEAR(balance[k], 0, 1e-9) << t[k];
  }
  EXPECT_EQ(run.last("D.power"), 0);
}

/// A parallelogram with cranks of 1 m at the angle given, the second one of mass m.
std::string parallelogram(double angle, double m, double omega, const std::string& rest) {
  const std::string x = std::to_string(std::cos(angle)), y = std::to_string(std::sin(angle));
  const std::string right = std::to_string(std::cos(angle) + 2);
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
      "c": {"rod": {"from": [0, 0], "to": [)" +
         x + ", " + y + R"(]}, "mass": 1, "angular_velocity": )" + std::to_string(omega) + R"(},
      "k": {"rod": {"from": [)" +
         x + ", " + y + R"(], "to": [)" + right + ", " + y + R"(]}, "mass": 2},
      "q": {"rod": {"from": [2, 0], "to": [)" +
         right + ", " + y + R"(]}, "mass": )" + std::to_string(m) + R"(, "angular_velocity": )" +
         std::to_string(omega) + R"(}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "c.from"},
                    {"type": "revolute", "name": "A", "i": "c.to", "j": "k.from"},
                    {"type": "revolute", "name": "B", "i": "k.to", "j": "q.to"},
                    {"type": "revolute", "name": "C", "i": ["ground", [2, 0]], "j": "q.from"}], )" +
         rest + "}";
}

// Driven at constant speed through its flat position at 1 s: the second crank does not accelerate, the driver carries
// half the weight of crank 1, the coupler's, and half of crank 2: (0.5 + 2 + 0.5) g.
TEST(DynamicsRows, AtASingularPositionAreTheLimitOfTheMotion) {
  const TextRun run = run_text(parallelogram(1, 1, -1,
                                             R"("drivers": [{"type": "absolute_angle", "name": "D", "i": "c",
        "value": {"polynomial": [1, -1]}}], "outputs": ["q.alpha", "k.alpha", "D.load", "q.angle"],
      "analyses": [{"type": "dynamics", "at": [0.9, 1, 1.1], "tolerance": 1e-10}])"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  ASSERT_EQ(run.column("t").size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(run.column("q.alpha")[k], 0, 1e-4) << k;
    EXPECT_NEAR(run.column("k.alpha")[k], 0, 1e-4) << k;
    EXPECT_NEAR(run.column("D.load")[k], 3 * 9.81 * std::cos(1 - run.column("t")[k]), 1e-4) << k;
  }
  EXPECT_NEAR(run.column("q.angle")[1], 0, 1e-6);
  std::string warning;
  for (const std::string& one : run.analysis().report.warnings) warning += one + "; ";
  EXPECT_NE(warning.find("at t = 1 s the mechanism is in a singular position"), std::string::npos) << warning;
  EXPECT_NE(warning.find("grow without bound"), std::string::npos) << warning;
}

// A release after the flat position begins a new phase: what the first one passed is told at the end all the same.
TEST(DynamicsRows, SingularPositionsOfEarlierPhasesAreTold) {
  const TextRun run = run_text(parallelogram(1, 1, -1,
                                             R"("drivers": [{"type": "absolute_angle", "name": "D", "i": "c",
        "value": {"polynomial": [1, -1]}}], "outputs": ["q.alpha", "D.load"],
      "analyses": [{"type": "dynamics", "until": 1.5, "every": 0.5, "tolerance": 1e-8,
        "events": [{"name": "free", "when": "q.angle", "value": -0.3, "action": "release", "element": "D"}]}])"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.column("t").size(), 5u);  // four of the grid, and that of the release
  std::string warning;
  for (const std::string& one : run.analysis().report.warnings) warning += one + "; ";
  EXPECT_NE(warning.find("at t = 1 s the mechanism is in a singular position"), std::string::npos) << warning;
}

// Started flat, cranks of 1 and 3 kg: alpha = -(m1/2 + m2 + m3/2) g / ((m1 + m3)/3 + m2) = -1.2 g on either crank.
TEST(DynamicsRows, StartAtASingularPosition) {
  const TextRun run = run_text(parallelogram(0, 3, -1,
                                             R"("outputs": ["c.alpha", "q.alpha", "c.omega", "energy.balance"],
      "analyses": [{"type": "dynamics", "until": 0.1, "every": 0.05, "tolerance": 1e-10}])"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.first("c.alpha"), -1.2 * 9.81, 1e-6);
  EXPECT_NEAR(run.first("q.alpha"), -1.2 * 9.81, 1e-6);
  for (double gap : run.column("energy.balance")) EXPECT_NEAR(gap, 0, 1e-8);

  const TextRun driven = run_text(parallelogram(0, 3, -1,
                                                R"("drivers": [{"type": "absolute_angle", "name": "D", "i": "c",
        "value": {"polynomial": [0, -1]}}], "outputs": ["D.load", "D.work", "energy.balance"],
      "analyses": [{"type": "dynamics", "until": 0.002, "every": 0.001, "tolerance": 1e-10}])"));
  ASSERT_EQ(driven.outcome.exit_code, 0) << driven.outcome.error_text;
  // Work against the weights that sink: -(0.5 + 2 + 1.5) g sin(t).
  EXPECT_NEAR(driven.first("D.load"), 4 * 9.81, 1e-6);
  EXPECT_NEAR(driven.last("D.work"), -4 * 9.81 * std::sin(0.002), 1e-7);
  for (double gap : driven.column("energy.balance")) EXPECT_NEAR(gap, 0, 1e-7);
}

bool says(const AnalysisResult& result, const std::string& part) {
  if (result.report.message.find(part) != std::string::npos) return true;
  for (const std::string& warning : result.report.warnings) {
    if (warning.find(part) != std::string::npos) return true;
  }
  return false;
}

// An arm of 1 m and a fore arm of sqrt(1.66^2 + 0.36^2) m, led away at 0.3 m/s until it is stretched out.
TEST(DynamicsRows, EndWhereDriversLockUp) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
      "a": {"rod": {"from": [0, 0], "to": [0.54, 0.84]}, "mass": 1},
      "b": {"rod": {"from": [0.54, 0.84], "to": [2.2, 1.2]}, "mass": 1}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"},
                    {"type": "revolute", "i": "a.to", "j": "b.from"}],
    "drivers": [{"type": "absolute_x", "name": "D", "i": "b.to", "value": {"polynomial": [2.2, 0.3]}},
                {"type": "absolute_y", "name": "E", "i": "b.to", "value": 1.2}],
    "analyses": [{"type": "dynamics", "until": 5, "every": 0.1, "outputs": ["a.angle"]}]})");
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::lock_up) << run.analysis().report.message;
  EXPECT_TRUE(says(run.analysis(), "\"D\"")) << run.analysis().report.message;
  const double reach = std::hypot(0.54, 0.84) + std::hypot(1.66, 0.36);
  const double stretched = (std::sqrt(reach * reach - 1.44) - 2.2) / 0.3;
  EXPECT_TRUE(says(run.analysis(), "t = " + std::to_string(stretched).substr(0, 6))) << run.analysis().report.message;
  // The last row is the place where it locks, without rates; what is known of it stands in fields.
  EXPECT_NEAR(run.last("t"), stretched, 1e-9);
  EXPECT_NEAR(run.last("a.angle"), std::asin(1.2 / reach), 1e-7);
  const auto singular = field<std::vector<FieldRecord>>(run, "singular");
  ASSERT_EQ(singular.size(), 1u);
  const auto entry = [&](const std::string& name) -> const FieldScalar& {
    for (const auto& [key, value] : singular[0]) {
      if (key == name) return value;
    }
    throw std::out_of_range(name);
  };
  EXPECT_NEAR(std::get<double>(entry("t")), stretched, 1e-9);
  EXPECT_EQ(std::get<std::string>(entry("kind")), "lock_up");
  EXPECT_EQ(std::get<std::vector<std::string>>(entry("bodies")).size(), 2u);
  EXPECT_EQ(std::get<std::vector<std::string>>(entry("branches")).size(), 1u);
  EXPECT_EQ(std::get<std::string>(entry("driver")), "D");
  EXPECT_NEAR(std::get<double>(entry("value")), 2.2 + 0.3 * stretched, 1e-9);
}

// Beside an arm that is stretched out, another one goes on: the row at that instant has both, at either's tolerance.
TEST(DynamicsRows, TheRowAtALockUpHasTheMechanismsBeside) {
  const auto scene = [](double stiffness) {
    return R"({"catena": 1, "bodies": {
        "ball": {"particle": true, "mass": 1, "position": [9, 0]},
        "crank": {"mass": 1, "rod": {"from": [0, 0], "to": [0.6, 0.8]}},
        "rod": {"mass": 1, "rod": {"from": [0.6, 0.8], "to": [2.1, 0.8]}}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
                      {"type": "revolute", "i": "crank.to", "j": "rod.from"},
                      {"type": "absolute_y", "i": "ball", "value": 0}],
      "drivers": [{"type": "absolute_y", "name": "E", "i": "rod.to", "value": 0.8},
                  {"type": "absolute_x", "name": "D", "i": "rod.to", "value": {"polynomial": [2.1, 0.3]}}],
      "forces": [{"type": "spring_damper", "i": ["ground", [8, 0]], "j": "ball", "length": 0.5, "k": )" +
           std::to_string(stiffness) + R"(}],
      "outputs": ["ball.x", "ball.vx", "crank.angle"], "analyses": [{"type": "dynamics", "until": 3, "every": 0.1}]})";
  };
  const double lock = (std::sqrt(2.5 * 2.5 - 0.64) - 2.1) / 0.3;
  for (const double stiffness : {4.0, 4e6}) {
    const TextRun run = run_text(scene(stiffness));
    EXPECT_EQ(run.analysis().report.status, Status::lock_up) << run.analysis().report.message;
    EXPECT_NEAR(run.last("t"), lock, 1e-9);
    EXPECT_NEAR(run.last("crank.angle"), std::asin(0.8 / 2.5), 1e-7);
    EXPECT_NEAR(run.last("ball.x"), 8.5 + 0.5 * std::cos(std::sqrt(stiffness) * lock), 1e-4) << stiffness;
    EXPECT_EQ(field<std::vector<FieldRecord>>(run, "singular").size(), 1u);
  }
}

TEST(DynamicsRows, EndAfterTheStepsAllowed) {
  const auto falling = [](const std::string& steps) {
    return run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"rod": {"from": [0, 0], "to": [2, 0]}, "mass": 3}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "b.from"}],
      "analyses": [{"type": "dynamics", "until": 1, "every": 0.5, "outputs": ["b.x"], "max_steps": )" +
        steps + "}]}");
  };
  const TextRun few = falling("3");
  EXPECT_EQ(few.outcome.exit_code, 1);
  EXPECT_EQ(few.analysis().report.status, Status::not_converged);
  EXPECT_TRUE(says(few.analysis(), "3 steps led to t = ")) << few.analysis().report.message;
  const TextRun enough = falling("1000");
  ASSERT_EQ(enough.outcome.exit_code, 0);
  const auto& counters = enough.analysis().report.counters;
  EXPECT_EQ(falling(std::to_string(counters.steps + counters.rejected)).outcome.exit_code, 0);
  // 1 s in steps of 0.01 s.
  for (const std::string method : {"rk8", "rk5", "radau", "alpha", "rattle"}) {
    const std::string fixed = R"(, "step": 0.01, "method": ")" + method + "\"";
    const TextRun cut = falling("50" + fixed);
    EXPECT_EQ(cut.analysis().report.status, Status::not_converged) << method;
    EXPECT_TRUE(says(cut.analysis(), "50 steps of 0.01 s led to t = 0.5 s, more than max_steps = 50 are needed"))
        << cut.analysis().report.message;
    EXPECT_EQ(falling("101" + fixed).outcome.exit_code, 0) << method;
  }
}

// A ball that bounces begins a phase at every impact, one on a spring at every touch; they are integrated apart.
TEST(DynamicsRows, StepsAllowedAreThoseOfAllPhasesAndMechanisms) {
  const auto bouncing = [](const std::string& options) {
    return run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
        "b": {"particle": true, "mass": 1, "position": [0, 1]}, "c": {"particle": true, "mass": 1, "position": [1, 3]}},
      "forces": [{"type": "contact", "i": "ground", "j": "b", "curve": {"line": {"point": [0, 0], "axis": [1, 0]}},
                  "restitution": 0.8},
                 {"type": "contact", "i": "ground", "j": "c", "curve": {"line": {"point": [0, 0], "axis": [1, 0]}},
                  "k": 1e5, "c": 10}],
      "outputs": ["b.y"], "analyses": [{"type": "dynamics", "until": 3, "every": 0.5)" +
                    options + "}]}");
  };
  for (const std::string options : {"", R"(, "method": "radau")", R"(, "method": "rk8", "step": 0.01)"}) {
    const TextRun all = bouncing(options);
    ASSERT_TRUE(all.analysis().report.ok()) << all.analysis().report.message;
    const auto& counters = all.analysis().report.counters;
    const std::int64_t steps = counters.steps + counters.rejected;
    EXPECT_TRUE(bouncing(options + ", \"max_steps\": " + std::to_string(steps)).analysis().report.ok());
    const TextRun cut = bouncing(options + ", \"max_steps\": " + std::to_string(steps - 10));
    EXPECT_EQ(cut.analysis().report.status, Status::not_converged) << options;
    EXPECT_TRUE(says(cut.analysis(), "more than max_steps = " + std::to_string(steps - 10)))
        << cut.analysis().report.message;
  }
}

TEST(DynamicsRows, WarningsHaveUnitsAndReasons) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
    "constraints": [{"type": "absolute_y", "i": "b", "value": 0}, {"type": "absolute_angle", "i": "b", "value": 0.5}],
    "drivers": [{"type": "absolute_x", "name": "D", "i": "b", "value": {"polynomial": [0, 0, 2]}}],
    "analyses": [{"type": "dynamics", "until": 3, "events": [
      {"name": "on", "when": "b.x", "value": 100, "action": "engage", "element": "D"},
      {"name": "off", "when": "t", "value": 1.5, "action": "release", "element": "D"}]}]})");
  EXPECT_TRUE(says(run.analysis(), "\"D\" does not hold from the start, since event \"on\" engages it"));
  EXPECT_TRUE(says(run.analysis(), "put \"off\" first in the list"));
  EXPECT_TRUE(says(run.analysis(), "shifted bodies by up to 0 m and turned them by up to 0.5 rad"));

  const TextRun caught = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"b": {"rod": {"from": [0, 0], "to": [2, 0]}, "mass": 3, "velocity": [0, 0]}},
    "constraints": [{"type": "revolute", "name": "A", "i": ["ground", [0, -1]], "j": "b.from"}],
    "analyses": [{"type": "dynamics", "until": 1, "every": 0.5, "events": [
      {"when": "b.from.y", "value": -1, "direction": "down", "action": "engage", "element": "A"}]}]})");
  EXPECT_TRUE(says(caught.analysis(), "the velocities at t = 0.451523640986 s did not meet the constraints"));
  EXPECT_TRUE(says(caught.analysis(), " rad/s (body \"b\")"));
}

// y'' + 2 y' + 100 y = -10 from rest at zero, where the spring has no direction: without a column of energy as with it.
TEST(DynamicsRows, ADamperMayBeginWithoutALength) {
  for (const std::string energy : {"", R"(, "energy.balance")"}) {
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10], "bodies": {"p": {"particle": true, "mass": 1}},
      "constraints": [{"type": "absolute_x", "i": "p", "value": 0},
                      {"type": "absolute_y", "name": "pin", "i": "p", "value": 0}],
      "forces": [{"type": "spring_damper", "i": "ground", "j": "p", "k": 100, "c": 2, "length": 0}],
      "outputs": ["p.y")" + energy +
                                 R"(], "analyses": [{"type": "dynamics", "until": 2, "events": [
        {"name": "breaks", "when": "t", "value": 1, "action": "release", "element": "pin"}]}]})");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    const double w = std::sqrt(99.0);
    EXPECT_NEAR(run.last("p.y"), -0.1 * (1 - std::exp(-1.0) * (std::cos(w) + std::sin(w) / w)), 1e-8);
  }
}

// A frame that nothing can move, of independent constraints: what rounding leaves of the velocities is no motion, and
// its energy none to be watched.
// A rod that is let go level comes to rest level on the other side after 2 K sqrt(2 l / 3 g), K = K(sin 45 deg); in so
// few steps its energy is hardly ever looked at, and where it rests there is little to compare an error with.
TEST(DynamicsRows, AMotionMayEndWhereItRests) {
  constexpr double g = 9.81, quarter = 1.854074677301372;
  const double at_rest = 3 * g / (8 * quarter * quarter);
  for (int n = -20; n <= 20; ++n) {
    const double length = at_rest * (1 + 1e-4 * n), turn = 2 * quarter * std::sqrt(2 * length / (3 * g));
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
      "bodies": {{"rod": {{"mass": 1, "rod": {{"from": [0, 0], "to": [{:.17g}, 0]}}}}}},
      "constraints": [{{"type": "revolute", "i": "ground", "j": "rod.from"}}],
      "outputs": ["rod.angle"], "analyses": [{{"type": "dynamics", "until": 1}}]}})",
                                             length));
    ASSERT_EQ(run.outcome.exit_code, 0) << length << " " << run.outcome.error_text;
    EXPECT_NEAR(run.last("rod.angle"), -std::numbers::pi + 0.75 * g / length * (1 - turn) * (1 - turn), 1e-7) << length;
  }
}

// Two weights that a stiff spring joins bounce on an elastic floor: long phases, each of which ends inside of a step.
// What the step says beyond its end, where the floor would pull, is no motion. Nothing is lost, whichever step it is.
TEST(DynamicsRows, StepsThatContactsCutShortAreJudgedWhereTheyEnd) {
  for (int n = 0; n < 30; n += size_of_test(1, 6)) {
    // The first one met the end of a phase in a step after which energies are checked.
    const double k = n == 0 ? 274.0864675308632 : 100 * std::pow(10, n / 30.0);
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81],
      "bodies": {{"low": {{"mass": 1, "particle": true, "position": [0, 0.3983248965527403]}},
                  "high": {{"mass": 1, "particle": true, "position": [0, 0.6983248965527403]}}}},
      "constraints": [{{"type": "absolute_x", "i": "low", "value": 0}}, {{"type": "absolute_x", "i": "high", "value": 0}}],
      "forces": [{{"type": "spring_damper", "i": "low", "j": "high", "k": 30000, "length": 0.31}},
        {{"type": "contact", "i": "ground", "j": "low", "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}, "k": {:.17g}}}],
      "outputs": ["energy.balance"], "analyses": [{{"type": "dynamics", "until": 1.5, "tolerance": 1e-10}}]}})",
                                             k));
    ASSERT_EQ(run.outcome.exit_code, 0) << k << " " << run.outcome.error_text;
    for (const double missing : run.column("energy.balance")) EXPECT_NEAR(missing, 0, 1e-8) << k;
  }
}

TEST(DynamicsRows, VelocitiesThatNothingAllowsAreNoMotion) {
  for (const char* speed : {"1e-18", "1e-6", "1", "1000"}) {
    const TextRun run = run_text(R"({"catena": 1, "parameters": {"v": )" + std::string(speed) + R"(}, "bodies": {
      "a": {"mass": 2, "inertia": 3, "position": [1.3, 0.7], "angle": 0.3, "velocity": ["v", "=-0.3*v"],
            "angular_velocity": "=0.7*v"}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a", "at": [0.123, 0.456]},
                      {"type": "coupler", "i": ["ground", [3.1, 1.7]], "j": ["a", [0.3, 0.77]]}],
      "outputs": ["a.vx", "a.omega", "a.angle"], "analyses": [{"type": "dynamics", "until": 1}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << speed << run.outcome.error_text << run.analysis().report.message;
    EXPECT_EQ(run.last("a.vx"), 0) << speed;
    EXPECT_EQ(run.last("a.omega"), 0) << speed;
    EXPECT_NEAR(run.last("a.angle"), 0.3, 1e-12) << speed;
  }
}

// A torque 5 sin(3 t) on crank 1 drives the parallelogram through its flat positions: (8/3) theta'' = tau - 29.43 cos.
// What the torque's potential gains by time alone is no energy that the step lacks.
TEST(DynamicsRows, LoadsThatFollowTheTimePassFlatPositions) {
  const double begin = std::asin(0.6);  // whose corners have few digits
  const TextRun run = run_text(parallelogram(begin, 1, 6,
                                             R"("forces": [{"type": "torque", "name": "T", "i": "c",
        "torque": {"harmonic": {"amplitude": 5, "omega": 3}}}], "outputs": ["q.angle", "c.omega"],
      "analyses": [{"type": "dynamics", "at": [0.5, 1, 1.5, 2], "tolerance": 1e-9}])"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  double theta = begin, omega = 6;
  const auto alpha = [](double t, double angle) { return (5 * std::sin(3 * t) - 29.43 * std::cos(angle)) / (8.0 / 3); };
  constexpr int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    const double t = 2.0 * k / steps, h = 2.0 / steps;
    const double a1 = alpha(t, theta), v2 = omega + h / 2 * a1, a2 = alpha(t + h / 2, theta + h / 2 * omega);
    const double v3 = omega + h / 2 * a2, a3 = alpha(t + h / 2, theta + h / 2 * v2), v4 = omega + h * a3;
    const double a4 = alpha(t + h, theta + h * v3);
    theta += h / 6 * (omega + 2 * v2 + 2 * v3 + v4);
    omega += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  EXPECT_GT(std::abs(theta), 3) << "no flat position was passed";
  EXPECT_NEAR(run.column("q.angle").back(), theta, 1e-7);
  EXPECT_NEAR(run.column("c.omega").back(), omega, 1e-6);
}

// Joints beside a weld, and between bodies that cannot move, have more rows than these have coordinates.
TEST(DynamicsRows, PartitioningCountsFreedomsBesideHeldBodies) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"w": {"mass": 1, "inertia": 0.1}, "f": {"fixed": true},
               "p": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1}},
    "constraints": [{"type": "weld", "name": "W", "i": "ground", "j": "w"},
                    {"type": "revolute", "name": "R", "i": "ground", "j": "w"},
                    {"type": "revolute", "name": "F", "i": "ground", "j": "f"},
                    {"type": "revolute", "name": "P", "i": "ground", "j": "p.from"}],
    "outputs": ["p.angle", "p.omega"],
    "analyses": [{"type": "dynamics", "until": 1, "method": "partitioning", "tolerance": 1e-9}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  // The pendulum's energy: omega^2 / 6 = -9.81 sin(angle) / 2.
  for (std::size_t k = 0; k < run.column("t").size(); ++k)
    EXPECT_NEAR(std::pow(run.column("p.omega")[k], 2), -29.43 * std::sin(run.column("p.angle")[k]), 1e-6) << k;
}

}  // namespace
}  // namespace catena::testing
