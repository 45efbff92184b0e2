// Events of dynamics: found where they happen, whatever the rows and steps are, and acted upon.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct Happened {
  std::string name;
  double t;
  std::int64_t row;
};

std::vector<Happened> events_of(const AnalysisResult& result) {
  std::vector<Happened> all;
  for (const NamedField& field : result.fields) {
    if (field.name != "events") continue;
    for (const FieldRecord& record : std::get<std::vector<FieldRecord>>(field.value)) {
      all.push_back({std::get<std::string>(record[0].second), std::get<double>(record[1].second),
                     std::get<std::int64_t>(record[2].second)});
    }
  }
  return all;
}

/// A ball thrown up from the ground with 12 m/s, gravity 10 m/s^2: y = 12 t - 5 t^2, highest at 1.2 s and 7.2 m.
std::string ball(const std::string& events, const std::string& more = "") {
  return R"({"catena": 1, "gravity": [0, -10], "bodies": {"ball": {"mass": 2, "particle": true, "velocity": [3, 12]}},
    "outputs": ["ball.x", "ball.y"],
    "analyses": [{"type": "dynamics", "until": 2.4, "every": 0.5, "events": [)" +
         events + "]}" + more + "]}";
}

TEST(Events, AreRecordedInARowOfTheirOwn) {
  const TextRun run = run_text(ball(R"({"name": "four", "when": "ball.y", "value": 4})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<Happened> events = events_of(run.analysis());
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(events[0].t, 1.2 - 0.8, 1e-13);
  EXPECT_NEAR(events[1].t, 1.2 + 0.8, 1e-13);
  const std::vector<double> t = run.column("t"), y = run.column("ball.y");
  for (const Happened& event : events) {
    EXPECT_EQ(event.name, "four");
    EXPECT_EQ(t[static_cast<std::size_t>(event.row)], event.t);
    EXPECT_NEAR(y[static_cast<std::size_t>(event.row)], 4, 1e-12);
  }
  // The rows that were asked for are there as well; one of them is that of the second event, at 2.0 s.
  EXPECT_EQ(t.size() - (std::abs(events[1].t - 2) > 0 ? 2 : 1), 6u);
  EXPECT_TRUE(std::is_sorted(t.begin(), t.end()));
}

TEST(Events, HaveADirection) {
  const auto times = [](const std::string& direction, double value) {
    const TextRun run = run_text(ball(R"({"name": "e", "when": "ball.y", "value": )" + std::to_string(value) +
                                      R"(, "direction": ")" + direction + "\"}"));
    std::vector<double> t;
    for (const Happened& event : events_of(run.analysis())) t.push_back(event.t);
    return t;
  };
  ASSERT_EQ(times("up", 4).size(), 1u);
  EXPECT_NEAR(times("up", 4)[0], 0.4, 1e-13);
  ASSERT_EQ(times("down", 4).size(), 1u);
  EXPECT_NEAR(times("down", 4)[0], 2, 1e-13);
  // It starts at zero: no event; it comes back to it in the last row.
  EXPECT_LE(times("any", 0).size(), 1u);
  EXPECT_EQ(times("up", 0).size(), 0u);
}

// The highest point lies between samples: just below it the value is passed twice, just above never.
TEST(Events, AreNotOverlookedAtATurningPoint) {
  const auto count = [](double value) {
    return events_of(run_text(ball(R"({"when": "ball.y", "value": )" + std::to_string(value) + "}")).analysis()).size();
  };
  EXPECT_EQ(count(7.19), 2u);
  EXPECT_EQ(count(7.199999), 2u);
  EXPECT_EQ(count(7.200001), 0u);
}

// Free of forces nothing keeps steps short: many turns, or a whole flight, in one of them.
TEST(Events, AreNotOverlookedInLongSteps) {
  const TextRun spin = run_text(R"({"catena": 1,
    "bodies": {"b": {"mass": 1, "inertia": 1, "angular_velocity": 100, "points": {"p": [1, 0]}}},
    "analyses": [{"type": "dynamics", "until": 1, "every": 1, "outputs": ["b.angle"],
      "events": [{"name": "up", "when": "b.p.y", "direction": "up"},
                 {"name": "top", "when": "b.p.y", "value": 0.9999}]}]})");
  ASSERT_EQ(spin.outcome.exit_code, 0) << spin.outcome.error_text;
  const double turn = 2 * std::numbers::pi / 100, near_top = std::asin(0.9999) / 100;
  std::vector<double> up, top;
  for (const Happened& event : events_of(spin.analysis())) (event.name == "up" ? up : top).push_back(event.t);
  ASSERT_EQ(up.size(), 15u);
  for (std::size_t k = 0; k < up.size(); ++k) EXPECT_NEAR(up[k], turn * static_cast<double>(k + 1), 1e-12);
  ASSERT_EQ(top.size(), 32u);
  for (std::size_t k = 0; k < top.size(); ++k) {
    EXPECT_NEAR(top[k], turn * static_cast<double>(k / 2) + (k % 2 ? turn / 2 - near_top : near_top), 1e-10);
  }
}

// Wherever steps end, and be it at the highest point itself.
TEST(Events, AreNotOverlookedWhereStepsEnd) {
  for (double v = 8; v < 12; v += 0.125) {
    const double height = v * v / 20 - 0.01;
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
      "bodies": {"b": {"mass": 1, "inertia": 1, "velocity": [0, )" +
                                 std::to_string(v) + R"(]}},
      "analyses": [{"type": "dynamics", "until": 2, "every": 2,
        "events": [{"when": "b.y", "value": )" +
                                 std::to_string(height) + "}]}]}");
    const std::vector<Happened> events = events_of(run.analysis());
    ASSERT_EQ(events.size(), 2u) << v;
    EXPECT_NEAR(events[0].t + events[1].t, v / 5, 1e-6) << v;
    EXPECT_NEAR(events[1].t - events[0].t, 2 * std::sqrt(0.002), 1e-4) << v;
  }
}

TEST(Events, StopAndTheNextAnalysisGoesOnFromThere) {
  const TextRun run =
      run_text(ball(R"({"name": "lands", "when": "ball.y", "value": 4, "direction": "down", "action": "stop"})",
                    R"(, {"type": "dynamics", "until": 2.2, "every": 0.1})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.analysis().report.status, Status::ok);
  EXPECT_NE(run.analysis().report.message.find("\"lands\""), std::string::npos) << run.analysis().report.message;
  EXPECT_NEAR(run.last("t", 0), 2, 1e-13);
  EXPECT_NEAR(run.last("ball.y", 0), 4, 1e-12);
  EXPECT_EQ(run.first("t", 1), run.last("t", 0));
  EXPECT_NEAR(run.first("ball.y", 1), 4, 1e-12);
  EXPECT_NEAR(run.last("ball.y", 1), 12 * 2.2 - 5 * 2.2 * 2.2, 1e-11);
}

// A wheel arm turns about a pin at 2 rad/s; at a quarter turn the pin breaks: its end goes on straight.
TEST(Events, ReleaseAJoint) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"arm": {"mass": 3, "rod": {"from": [0, 0], "to": [2, 0]}, "angular_velocity": 2}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "arm.from"}],
    "outputs": ["arm.x", "arm.y", "arm.angle", "arm.from.x", "pin.angle", "pin.reaction", "energy"],
    "analyses": [{"type": "dynamics", "until": 2, "every": 0.25, "tolerance": 1e-11,
      "events": [{"name": "breaks", "when": "pin.angle", "value": "90 deg", "action": "release", "element": "pin"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<Happened> events = events_of(run.analysis());
  ASSERT_EQ(events.size(), 1u);
  const double quarter = std::numbers::pi / 4;
  EXPECT_NEAR(events[0].t, quarter, 1e-12);
  const std::vector<double> t = run.column("t"), x = run.column("arm.x"), y = run.column("arm.y");
  const std::vector<double> pull = run.column("pin.fx"), angle = run.column("pin.angle");
  const std::vector<double> balance = run.column("energy.balance");
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(angle[k], 2 * t[k], 1e-9);
    EXPECT_NEAR(balance[k], 0, 1e-9);
    // The row of the event itself is still held; its instant is known to rounding.
    if (t[k] <= quarter + 1e-12) {
      EXPECT_NEAR(x[k], std::cos(2 * t[k]), 1e-9);
      EXPECT_NEAR(pull[k], -3 * 4 * std::cos(2 * t[k]), 1e-8);  // m omega^2 towards the pin
    } else {
      EXPECT_NEAR(x[k], -2 * (t[k] - quarter), 1e-9);
      EXPECT_NEAR(y[k], 1, 1e-9);
      EXPECT_EQ(pull[k], 0);
    }
  }
}

// Two carriages: the moving one catches up with the other and couples. Momentum stays, energy goes.
TEST(Events, EngageACoupling) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"a": {"mass": 3, "inertia": 1, "velocity": [2, 0]},
               "b": {"mass": 1, "inertia": 1, "position": [4, 0]}},
    "constraints": [{"type": "translational", "i": "ground", "j": "a", "axis_i": [1, 0], "axis_j": [1, 0]},
                    {"type": "translational", "i": "ground", "j": "b", "axis_i": [1, 0], "axis_j": [1, 0]},
                    {"type": "relative_distance", "name": "coupling", "i": "a", "j": "b", "value": 1}],
    "outputs": ["a.x", "b.x", "a.vx", "b.vx", "coupling.value", "coupling.fx", "energy", "momentum.x"],
    "analyses": [{"type": "dynamics", "until": 3, "every": 0.5, "tolerance": 1e-10,
      "events": [{"name": "meet", "when": "coupling.value", "value": 1, "direction": "down",
                  "action": "engage", "element": "coupling"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<Happened> events = events_of(run.analysis());
  ASSERT_EQ(events.size(), 1u);
  EXPECT_NEAR(events[0].t, 1.5, 1e-12);
  EXPECT_NEAR(run.first("coupling.value"), 4, 1e-12);
  EXPECT_NEAR(run.last("a.x"), 3 + 1.5 * 1.5, 1e-9);
  EXPECT_NEAR(run.last("b.x"), 4 + 1.5 * 1.5, 1e-9);
  EXPECT_NEAR(run.last("a.vx"), 1.5, 1e-10);
  EXPECT_NEAR(run.last("b.vx"), 1.5, 1e-10);
  EXPECT_NEAR(run.last("energy.dissipated"), 6 - 4.5, 1e-9);
  for (const double balance : run.column("energy.balance")) EXPECT_NEAR(balance, 0, 1e-9);
  for (const double momentum : run.column("momentum.x")) EXPECT_NEAR(momentum, 6, 1e-10);
}

TEST(Events, EngageOnlyWhatFits) {
  const TextRun run = run_text(R"({"catena": 1,
    "bodies": {"a": {"mass": 3, "particle": true, "velocity": [2, 0]}},
    "constraints": [{"type": "absolute_x", "name": "wall", "i": "a", "value": 5}],
    "analyses": [{"type": "dynamics", "until": 3,
      "events": [{"when": "a.x", "value": 4, "action": "engage", "element": "wall"}]}]})");
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::inconsistent);
  EXPECT_NE(run.analysis().report.message.find("\"wall\" cannot be engaged at t = 2 s: it misses by 1 m"),
            std::string::npos)
      << run.analysis().report.message;
}

// Wrong requests are told at their place.
TEST(Events, AreCheckedBeforeAnythingRuns) {
  const auto expect = [](const std::string& event, const std::string& message) {
    const MarkedText marked = take_mark(R"({"catena": 1, "bodies": {"a": {"mass": 1, "inertia": 1}},
      "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "a"}],
      "forces": [{"type": "torque", "name": "motor", "i": "a", "torque": 1}],
      "analyses": [{"type": "dynamics", "until": 1, "events": [)" +
                                        event + "]}]}");
    const TextRun run = run_text(marked.text);
    EXPECT_EQ(run.outcome.exit_code, 3);
    ASSERT_EQ(run.outcome.errors.size(), 1u) << run.outcome.error_text;
    EXPECT_EQ(run.outcome.errors[0].line, marked.line) << message;
    EXPECT_EQ(run.outcome.errors[0].column, marked.column) << message;
    EXPECT_NE(run.outcome.errors[0].message.find(message), std::string::npos) << run.outcome.errors[0].message;
  };
  expect(R"({"when": §"a.z"})", "unknown column \"a.z\"");
  expect(R"({"when": §"a"})", "\"a\" stands for 9 of them");
  expect(R"(§{"name": "e"})", "needs \"when\"");
  expect(R"({"when": "a.x", "direction": §"sideways"})", "sideways");
  expect(R"({"when": "a.x", "action": §"explode"})", "explode");
  expect(R"(§{"when": "a.x", "action": "release"})", "needs \"element\"");
  expect(R"({"when": "a.x", "action": "release", "element": §"pim"})", "did you mean \"pin\"?");
  expect(R"({"when": "a.x", "action": "release", "element": §"motor"})", "is a force");
  expect(R"({"when": "a.x", "element": §"pin"})", "has no meaning");
  expect(R"({"when": "a.x", §"valve": 3})", "did you mean \"value\"?");
}

}  // namespace
}  // namespace catena::testing
