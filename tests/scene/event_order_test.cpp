// Events at one instant: in the order of the list, each with its row, then what they do; names and kinds; blocks.
#include <gtest/gtest.h>

#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

std::string ball(const std::string& events, const std::string& more = "", const std::string& until = "1") {
  return R"({"catena": 1, "bodies": {"a": {"mass": 2, "particle": true, "velocity": [3, 0]},
                                     "b": {"mass": 1, "particle": true, "position": [0, 1], "velocity": [6, 0]}},
    "constraints": [{"type": "absolute_y", "name": "rail", "i": "a", "value": 0}],
    "outputs": ["a.x", "a.vx", "a.vy", "b.x"],
    "analyses": [{"type": "dynamics", "until": )" +
         until + R"(, "every": 0.25, "events": [)" + events + "]" + more + "}]}";
}

std::vector<std::string> names_of(const TextRun& run) {
  std::vector<std::string> names;
  for (const EventEntry& event : events_of(run)) names.push_back(event.name);
  return names;
}

// Columns that reach their values at 0.3 s along different ways: two bodies, the time itself, an expression.
TEST(EventOrder, SimultaneousOnesComeInTheOrderOfTheList) {
  const std::vector<std::string> events{R"({"name": "x", "when": "a.x", "value": 0.9})",
                                        R"({"name": "t", "when": "t", "value": 0.3})",
                                        R"({"name": "far", "when": "b.x", "value": 1.8})",
                                        R"({"name": "sum", "when": "=a.x + b.x - 9*t", "value": 0, "direction": "up"})",
                                        R"({"name": "both", "when": "=a.x + b.x", "value": 2.7})"};
  for (const std::vector<int>& order : {std::vector{0, 1, 2, 4}, {4, 2, 1, 0}, {1, 4, 0, 2}, {2, 0, 4, 1}}) {
    std::string list;
    std::vector<std::string> expected;
    for (const int k : order) {
      list += (list.empty() ? "" : ", ") + events[static_cast<std::size_t>(k)];
      expected.push_back(std::vector<std::string>{"x", "t", "far", "sum", "both"}[static_cast<std::size_t>(k)]);
    }
    const TextRun run = run_text(ball(list));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_EQ(names_of(run), expected);
    const std::vector<double> t = run.column("t");
    std::int64_t row = 2;  // after 0, 0.25
    for (const EventEntry& event : events_of(run)) {
      EXPECT_NEAR(event.t, 0.3, 1e-12);
      EXPECT_EQ(event.t, events_of(run).front().t) << "one instant";
      EXPECT_EQ(event.row, row++) << "a row each";
      EXPECT_EQ(t[static_cast<std::size_t>(event.row)], event.t);
    }
  }
}

// Each acts on what the one before left: a blow across the rail does nothing before it goes, all after.
TEST(EventOrder, ActionsOfOneInstantFollowEachOther) {
  const std::string release = R"({"name": "go", "when": "t", "value": 0.3, "action": "release", "element": "rail"})";
  const std::string blow = R"({"name": "blow", "when": "a.x", "value": 0.9, "impulse": {"i": "a", "value": [2, 4]}})";
  const TextRun first = run_text(ball(release + ", " + blow)), second = run_text(ball(blow + ", " + release));
  ASSERT_EQ(first.outcome.exit_code, 0) << first.analysis().report.message;
  ASSERT_EQ(second.outcome.exit_code, 0) << second.analysis().report.message;
  EXPECT_EQ(names_of(first), (std::vector<std::string>{"go", "blow"}));
  EXPECT_EQ(names_of(second), (std::vector<std::string>{"blow", "go"}));
  EXPECT_NEAR(first.last("a.vx"), 3 + 2 / 2., 1e-12);
  EXPECT_NEAR(first.last("a.vy"), 4 / 2., 1e-12);
  EXPECT_NEAR(second.last("a.vx"), 3 + 2 / 2., 1e-12);
  EXPECT_NEAR(second.last("a.vy"), 0, 1e-12);
  EXPECT_TRUE(impulses_of(first).empty());
  EXPECT_NEAR(impulse_of(second, "rail").py, -4, 1e-12);
  // The rows of both show what was before either acted.
  for (const TextRun* run : {&first, &second}) {
    for (const EventEntry& event : events_of(*run))
      EXPECT_NEAR(run->column("a.vx")[static_cast<std::size_t>(event.row)], 3, 1e-12);
  }
}

// A stop ends it: what the list has before it has acted, and the next analysis goes on from there.
TEST(EventOrder, AStopLetsOnlyThoseBeforeItAct) {
  const std::string stop = R"({"name": "end", "when": "a.x", "value": 0.9, "action": "stop"})";
  const std::string blow = R"({"name": "blow", "when": "t", "value": 0.3, "impulse": {"i": "a", "value": [2, 0]}})";
  const std::string next = R"(}, {"type": "dynamics", "until": 0.5, "every": 0.1, "outputs": ["a.vx"])";
  const TextRun before = run_text(ball(blow + ", " + stop, next)), after = run_text(ball(stop + ", " + blow, next));
  for (const TextRun* run : {&before, &after}) {
    ASSERT_EQ(run->outcome.exit_code, 0) << run->outcome.error_text << run->analysis().report.message;
    EXPECT_EQ(events_of(*run).size(), 2U);
    EXPECT_NEAR(run->last("t"), 0.3, 1e-12);
    EXPECT_NE(run->analysis().report.message.find("event \"end\" ended it"), std::string::npos);
  }
  EXPECT_NEAR(before.first("a.vx", 1), 4, 1e-12);
  EXPECT_NEAR(after.first("a.vx", 1), 3, 1e-12);
}

// A name may stand for several events; each entry says of which kind it is.
TEST(EventOrder, OneNameWithSeveralKinds) {
  const TextRun run = run_text(ball(R"({"name": "e", "when": "a.x", "value": 0.6},
    {"name": "e", "when": "a.x", "value": 0.9, "impulse": {"i": "a", "value": [2, 0]}},
    {"name": "e", "when": "b.x", "value": 3, "action": "release", "element": "rail"},
    {"name": "e", "when": "a.x", "value": 2.5, "action": "stop"})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<EventEntry> events = events_of(run);
  ASSERT_EQ(events.size(), 4U);
  const std::vector<std::string> kinds{"record", "impulse", "release", "stop"};
  const std::vector<double> times{0.2, 0.3, 0.5, 0.3 + 1.6 / 4};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(events[k].name, "e");
    EXPECT_EQ(events[k].kind, kinds[k]);
    EXPECT_NEAR(events[k].t, times[k], 1e-12);
  }
}

TEST(EventBlocks, AreRepeated) {
  // Balls thrown up with 1, 2, ... m/s; each is pushed and recorded by events of a block, with names of its own.
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10], "parameters": {"n": 5, "low": 0.05},
    "replicate": [{"count": "n", "bodies": {"ball{k}": {"mass": "=k", "particle": true, "position": ["=k", 0],
                                                        "velocity": [0, "=k"]}}}],
    "outputs": ["ball1.vx", "ball5.vx"],
    "analyses": [{"type": "dynamics", "until": 0.15, "tolerance": 1e-11,
      "events": [{"name": "all", "when": "t", "value": 0.14}],
      "replicate": [{"count": "=n-1", "first": 2, "events": [
          {"name": "pass{k}", "when": "=ball{k}.y - low - ball{k-1}.y*0", "direction": "up"},
          {"name": "lead{k}", "when": "=ball{k}.y - ball{k-1}.y - k/100", "direction": "up"}]},
        {"count": 2, "variable": "n2", "replicate": [{"count": 2, "first": "=n2", "variable": "m", "events": [
          {"name": "push{n2},{m}", "when": "t", "value": "=0.01*n2 + 0.001*m",
           "impulse": {"i": "ball{m}", "value": ["=m*n2", 0]}}]}]}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  std::map<std::string, double> t;
  for (const EventEntry& event : events_of(run)) {
    EXPECT_FALSE(t.contains(event.name)) << event.name;
    t[event.name] = event.t;
  }
  ASSERT_EQ(t.size(), 1U + 4 + 4 + 4);
  for (int k = 2; k <= 5; ++k) {
    // k t - 5 t^2 = 0.05, and k t - (k - 1) t = k / 100.
    EXPECT_NEAR(t["pass" + std::to_string(k)], (k - std::sqrt(k * k - 4 * 5 * 0.05)) / 10, 1e-11) << k;
    EXPECT_NEAR(t["lead" + std::to_string(k)], k / 100., 1e-12) << k;
  }
  EXPECT_NEAR(t["push1,1"], 0.011, 1e-12);
  EXPECT_NEAR(t["push2,3"], 0.023, 1e-12);
  EXPECT_NEAR(run.last("ball1.vx"), 1, 1e-12);
}

// A constraint of each k that its own event releases, all at one instant.
TEST(EventBlocks, ActTogether) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10],
    "replicate": [{"count": 150, "bodies": {"b{k}": {"mass": 1, "particle": true, "position": ["=k", 0]}},
                   "constraints": [{"type": "absolute_y", "name": "shelf{k}", "i": "b{k}", "value": 0}]}],
    "outputs": ["b1.y", "b75.y", "b150.y"],
    "analyses": [{"type": "dynamics", "until": 0.5,
      "replicate": [{"count": 150, "events": [{"name": "drop{k}", "when": "t", "value": 0.2, "action": "release",
                                               "element": "shelf{k}"}]}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<EventEntry> events = events_of(run);
  ASSERT_EQ(events.size(), 150U);
  for (std::size_t k = 0; k < events.size(); ++k) EXPECT_EQ(events[k].name, "drop" + std::to_string(k + 1));
  for (const char* ball : {"b1.y", "b75.y", "b150.y"}) EXPECT_NEAR(run.last(ball), -5 * 0.09, 1e-9) << ball;
}

TEST(EventBlocks, WrongOnesAreNamedWithTheirPlace) {
  const auto expect = [](const std::string& block, const std::string& message) {
    const MarkedText marked = take_mark(R"({"catena": 1, "bodies": {"b1": {"mass": 1, "inertia": 1}},
      "constraints": [{"type": "revolute", "name": "pin1", "i": "ground", "j": "b1"}],
      "analyses": [{"type": "dynamics", "until": 1, "replicate": [)" +
                                        block + "]}]}");
    const TextRun run = run_text(marked.text);
    EXPECT_EQ(run.outcome.exit_code, 3);
    ASSERT_EQ(run.outcome.errors.size(), 1u) << run.outcome.error_text;
    EXPECT_EQ(run.outcome.errors[0].line, marked.line) << message;
    EXPECT_EQ(run.outcome.errors[0].column, marked.column) << message << "\n" << run.outcome.error_text;
    EXPECT_NE(run.outcome.errors[0].message.find(message), std::string::npos) << run.outcome.errors[0].message;
  };
  expect(R"({"count": 3, "events": [{"when": §"b{k}.x"}]})", "unknown column \"b2.x\"");
  expect(R"({"count": 3, "events": [{"when": "=§b{k}.x - k"}]})", "unknown column \"b2.x\"");
  expect(R"({"count": 3, "events": [{"when": "b1.x", "action": "release", "element": §"pin{k}"}]})",
         "no constraint \"pin2\"");
  expect(R"({"count": 3, "events": [{"when": "b1.x", "impulse": §{"i": "b{k}", "value": [1, 0]}}]})",
         "no body \"b2\" to strike");
  expect(R"({"count": 3, "events": [{"when": "b1.x", "value": "=1§/(k-2) + 1"}]})", "(at k = 2)");
  expect(R"({"count": §2.5, "events": [{"when": "b1.x"}]})", "\"count\" of a block of events must be a whole number");
  expect(R"({"count": §-1, "events": [{"when": "b1.x"}]})", "\"count\" of a block of events is -1");
  expect(R"({"count": §1e7, "events": [{"when": "b1.x"}]})", "more than 1000000 events");
  expect(R"(§{"events": [{"when": "b1.x"}]})", "needs \"count\"");
  expect(R"(§{"count": 2})", "this one has none");
  expect(R"({"count": 2, §"event": [{"when": "b1.x"}], "events": []})", "unknown key \"event\"");
  expect(R"({"count": 2, "variable": §"pi", "events": [{"when": "b1.x"}]})", "pi");
  expect(R"({"count": 2, "events": [{"name": "e{§j}", "when": "b1.x"}]})", "j");
  expect(R"(§3)", "a block of events must be an object");
}

}  // namespace
}  // namespace catena::testing
