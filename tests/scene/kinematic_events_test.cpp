// Events of driven motions: found between rows however far apart these are, and acted upon.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// A crank of 2 m that turns with 3 rad/s from the x-axis on.
std::string crank(const std::string& events, const std::string& keys = R"("until": 2, "every": 0.5)",
                  const std::string& type = "kinematics", const std::string& more = "") {
  return R"({"catena": 1, "bodies": {"crank": {"mass": 1, "rod": {"from": [0, 0], "to": [2, 0]}}},
    "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "crank.from"}],
    "drivers": [{"type": "absolute_angle", "name": "motor", "i": "crank", "value": {"polynomial": [0, 3]}}],
    "outputs": ["crank.angle", "crank.to.x", "crank.to.y"],
    "analyses": [{"type": ")" +
         type + R"(", )" + keys + R"(, "events": [)" + events + "]}" + more + "]}";
}

TEST(KinematicEvents, AreRecordedInARowOfTheirOwn) {
  for (const std::string type : {"kinematics", "inverse_dynamics"}) {
    const TextRun run = run_text(crank(R"({"name": "high", "when": "crank.to.y", "value": 1},
      {"name": "left", "when": "=crank.to.x + 0.5", "direction": "down"},
      {"name": "half", "when": "crank.angle", "value": 3, "direction": "up"})",
                                       R"("until": 2, "every": 0.5)", type));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<EventEntry> events = events_of(run);
    ASSERT_EQ(events.size(), 4U);
    const std::vector<double> times{pi / 18, std::acos(-0.25) / 3, 5 * pi / 18, 1};
    const std::vector<std::string> names{"high", "left", "high", "half"};
    const std::vector<double> t = run.column("t"), y = run.column("crank.to.y");
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(events[k].name, names[k]);
      EXPECT_EQ(events[k].kind, "record");
      EXPECT_NEAR(events[k].t, times[k], 1e-13);
      ASSERT_LT(events[k].row, static_cast<std::int64_t>(t.size()));
      EXPECT_EQ(t[static_cast<std::size_t>(events[k].row)], events[k].t);
      EXPECT_NEAR(y[static_cast<std::size_t>(events[k].row)], 2 * std::sin(3 * events[k].t), 1e-12);
    }
    EXPECT_TRUE(std::is_sorted(t.begin(), t.end()));
    // Rows at 0, 0.5, 1, 1.5, 2 and three more; the last event happens at that of 1 s, up to rounding.
    EXPECT_TRUE(t.size() == 8 || t.size() == 9) << t.size();
  }
}

// One row at the end of a hundred turns.
TEST(KinematicEvents, AreNotOverlookedBetweenDistantRows) {
  const TextRun run = run_text(crank(R"({"name": "right", "when": "crank.to.x", "value": 1.99},
    {"name": "up", "when": "crank.to.y", "direction": "up"})",
                                     R"("at": 200)"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  std::vector<double> right, up;
  for (const EventEntry& event : events_of(run)) (event.name == "up" ? up : right).push_back(event.t);
  ASSERT_EQ(up.size(), 95U);  // 600 rad; it starts at zero
  for (std::size_t k = 0; k < up.size(); ++k) EXPECT_NEAR(up[k], 2 * pi / 3 * static_cast<double>(k + 1), 1e-11);
  const double away = std::acos(1.99 / 2) / 3;
  ASSERT_EQ(right.size(), 1U + 2 * 95);
  EXPECT_NEAR(right[0], away, 1e-10);
  for (std::size_t k = 1; k < right.size(); ++k) {
    const double turn = 2 * pi / 3 * static_cast<double>((k + 1) / 2);
    EXPECT_NEAR(right[k], turn + (k % 2 ? -away : away), 1e-10);
  }
}

// Motions without a turning body, whose equations are linear: nothing but the driver keeps steps short.
TEST(KinematicEvents, AreNotOverlookedInLinearMotions) {
  const double w = 40, phase = 0.3;
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {"particle": true}},
    "constraints": [{"type": "absolute_y", "i": "a", "value": 0}],
    "drivers": [{"type": "absolute_x", "i": "a", "value": {"harmonic": {"amplitude": 2, "omega": 40, "phase": 0.3}}}],
    "analyses": [{"type": "kinematics", "until": 10, "every": 10, "events": [{"when": "a.x", "value": 0.5},
      {"name": "top", "when": "a.vx", "direction": "down"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  std::vector<double> times, tops, expected, expected_tops;
  for (const EventEntry& event : events_of(run)) (event.name == "top" ? tops : times).push_back(event.t);
  for (int n = 0; n < 80; ++n) {
    for (const double angle : {std::asin(0.25) + 2 * pi * n, pi - std::asin(0.25) + 2 * pi * n}) {
      const double t = (angle - phase) / w;
      if (t > 0 && t < 10) expected.push_back(t);
    }
    if (const double t = (pi / 2 + 2 * pi * n - phase) / w; t < 10) expected_tops.push_back(t);
  }
  ASSERT_EQ(times.size(), expected.size());
  ASSERT_EQ(tops.size(), expected_tops.size());
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_NEAR(times[k], expected[k], 1e-12) << k;
  for (std::size_t k = 0; k < tops.size(); ++k) EXPECT_NEAR(tops[k], expected_tops[k], 1e-12) << k;
}

TEST(KinematicEvents, StopAndTheNextAnalysisGoesOnFromThere) {
  const TextRun run = run_text(crank(R"({"name": "top", "when": "crank.to.x", "direction": "down", "action": "stop"})",
                                     R"("until": 2, "every": 0.5)", "kinematics",
                                     R"(, {"type": "kinematics", "until": 1, "every": 0.25})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_EQ(run.analysis().report.message, fmt::format("event \"top\" ended it at t = {:.12g} s", pi / 6));
  EXPECT_EQ(events_of(run)[0].kind, "stop");
  EXPECT_NEAR(run.last("t"), pi / 6, 1e-13);
  EXPECT_NEAR(run.last("crank.to.x"), 0, 1e-12);
  EXPECT_EQ(run.first("t", 1), run.last("t"));
  EXPECT_NEAR(run.last("crank.angle", 1), 3, 1e-12);
}

// Velocities are handed on too: a flywheel is brought to speed and let go in the next analysis.
TEST(KinematicEvents, HandVelocitiesOn) {
  TextRun run =
      run_text(crank(R"({"when": "crank.angle", "value": 1.2, "action": "stop"})", R"("until": 2)", "kinematics",
                     R"(, {"type": "dynamics", "until": 1, "outputs": ["crank.omega"],
      "events": [{"when": "t", "value": 0.6, "action": "release", "element": "motor"}]})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis(1).report.message;
  EXPECT_NEAR(run.first("crank.omega", 1), 3, 1e-12);
  EXPECT_NEAR(run.last("crank.omega", 1), 3, 1e-9);
}

// One driver hands the slide over to another at the same instant; a brake that is engaged after some turns holds it.
TEST(KinematicEvents, ReleaseAndEngageDrivers) {
  const std::string scene = R"({"catena": 1, "bodies": {"a": {"particle": true}},
    "constraints": [{"type": "absolute_y", "i": "a", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "fast", "i": "a", "value": {"polynomial": [0, 4]}},
                {"type": "absolute_x", "name": "slow", "i": "a", "value": {"polynomial": [1.5, 1]}}],
    "outputs": ["a.x", "a.vx"],
    "analyses": [{"type": "kinematics", "until": 1, "every": 0.25, "events": [)";
  const std::string off = R"({"name": "off", "when": "a.x", "value": 2, "action": "release", "element": "fast"})";
  const std::string on = R"({"name": "on", "when": "a.x", "value": 2, "action": "engage", "element": "slow"})";
  for (const std::string& events : {off + ", " + on, on + ", " + off}) {
    const TextRun run = run_text(scene + events + R"(, {"name": "late", "when": "a.x", "value": 2.25}]}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<EventEntry> found = events_of(run);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].kind, events == off + ", " + on ? "release" : "engage");
    EXPECT_EQ(found[1].kind, events == off + ", " + on ? "engage" : "release");
    EXPECT_NEAR(found[0].t, 0.5, 1e-13);
    EXPECT_EQ(found[0].t, found[1].t);
    EXPECT_NEAR(found[2].t, 0.75, 1e-12);
    const std::vector<double> t = run.column("t"), x = run.column("a.x");
    for (std::size_t k = 0; k < t.size(); ++k) EXPECT_NEAR(x[k], t[k] < 0.5 + 1e-12 ? 4 * t[k] : 1.5 + t[k], 1e-12);
    EXPECT_NEAR(run.last("a.vx"), 1, 1e-12);
  }
  const TextRun turned = run_text(R"({"catena": 1, "bodies": {"a": {}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "a"}, {"type": "weld", "name": "brake", "i": "ground", "j": "a"}],
    "drivers": [{"type": "absolute_angle", "name": "motor", "i": "a", "value": {"polynomial": [0, 6]}}],
    "outputs": ["a.angle"],
    "analyses": [{"type": "kinematics", "until": 6, "events": [
      {"when": "a.angle", "value": "=6*pi", "action": "engage", "element": "brake"},
      {"when": "a.angle", "value": "=6*pi", "action": "release", "element": "motor"}]}]})");
  ASSERT_EQ(turned.outcome.exit_code, 0) << turned.outcome.error_text << turned.analysis().report.message;
  EXPECT_NEAR(turned.last("a.angle"), 6 * pi, 1e-12);
  EXPECT_NEAR(turned.last("t"), 6, 0);
}

TEST(KinematicEvents, TellWhatCannotGoOn) {
  const TextRun alone = run_text(crank(R"({"name": "off", "when": "t", "value": 0.7, "action": "release",
                                           "element": "motor"})"));
  EXPECT_EQ(alone.analysis().report.status, Status::under_driven);
  EXPECT_NE(alone.analysis().report.message.find("after event \"off\" released \"motor\": "), std::string::npos)
      << alone.analysis().report.message;
  EXPECT_NEAR(alone.last("t"), 0.7, 1e-13);
  const TextRun misfit = run_text(R"({"catena": 1, "bodies": {"a": {"particle": true}},
    "constraints": [{"type": "absolute_y", "i": "a", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "fast", "i": "a", "value": {"polynomial": [0, 4]}},
                {"type": "absolute_x", "name": "slow", "i": "a", "value": {"polynomial": [1.75, 1]}}],
    "analyses": [{"type": "kinematics", "until": 1, "events": [
      {"when": "t", "value": 0.5, "action": "release", "element": "fast"},
      {"when": "t", "value": 0.5, "action": "engage", "element": "slow"}]}]})");
  EXPECT_EQ(misfit.analysis().report.status, Status::inconsistent);
  EXPECT_NE(misfit.analysis().report.message.find("\"slow\" cannot be engaged at t = 0.5 s: it misses by 0.25 m"),
            std::string::npos)
      << misfit.analysis().report.message;
  const TextRun doubled = run_text(R"({"catena": 1, "bodies": {"a": {"particle": true}},
    "constraints": [{"type": "absolute_y", "i": "a", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "fast", "i": "a", "value": {"polynomial": [0, 4]}},
                {"type": "absolute_x", "name": "slow", "i": "a", "value": {"polynomial": [1.5, 1]}}],
    "analyses": [{"type": "kinematics", "until": 1, "events": [
      {"when": "t", "value": 0.5, "action": "engage", "element": "slow"}]}]})");
  EXPECT_EQ(doubled.analysis().report.status, Status::inconsistent) << doubled.analysis().report.message;
}

TEST(KinematicEvents, RefuseWhatADrivenMotionCannotHave) {
  const auto message_of = [](const std::string& scene) {
    const TextRun run = run_text(scene);
    EXPECT_EQ(run.analysis().report.status, Status::refused) << run.outcome.error_text;
    return run.analysis().report.message;
  };
  const std::string blow = R"({"name": "blow", "when": "t", "value": 1, "impulse": {"i": "crank", "value": [1, 0]}})";
  EXPECT_NE(message_of(crank(blow)).find("event \"blow\": an impulse changes no motion that drivers determine"),
            std::string::npos);
  const std::string off = R"({"name": "off", "when": "t", "value": 1, "action": "release", "element": "motor"})";
  EXPECT_NE(message_of(crank(off, R"("until": 2)", "inverse_dynamics")).find("event \"off\": velocities may jump"),
            std::string::npos);
  EXPECT_NE(message_of(crank(R"({"when": "t", "value": 1})", R"("at": [1, 0.5])")).find("forwards in time: 0.5 s"),
            std::string::npos);
  EXPECT_NE(message_of(R"({"catena": 1, "bodies": {"a": {"particle": true}},
    "drivers": [{"type": "absolute_x", "i": "a", "value": {"polynomial": [0, 4]}}],
    "analyses": [{"type": "kinematics", "until": 1, "free": "minimum_norm", "events": [{"when": "a.x", "value": 1}]}]})")
                .find("events are not looked for in a motion of least velocity"),
            std::string::npos);
  EXPECT_NE(message_of(crank(R"({"name": "e", "when": "motor.load", "value": 1})")).find("event \"e\""),
            std::string::npos);
}

// Before a mechanism locks; the row at the dead point comes last, and the event found there is before it.
TEST(KinematicEvents, AreFoundUpToWhereItLocks) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {"particle": true, "position": [0.1, 1]}},
    "constraints": [{"type": "absolute_distance", "i": "a", "ground": [0, 0], "value": 1}],
    "drivers": [{"type": "absolute_x", "name": "pull", "i": "a", "value": {"polynomial": [0, 2]}}],
    "outputs": ["a.x", "a.y", "pull.value"],
    "analyses": [{"type": "kinematics", "until": 5, "every": 5, "events": [
      {"name": "mid", "when": "a.x", "value": 0.5}, {"name": "low", "when": "a.y", "value": 0.01},
      {"name": "never", "when": "a.x", "value": 1.001}]}]})");
  EXPECT_EQ(run.analysis().report.status, Status::lock_up) << run.analysis().report.message;
  const std::vector<EventEntry> events = events_of(run);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_NEAR(events[0].t, 0.25, 1e-13);
  EXPECT_NEAR(events[1].t, std::sqrt(1 - 1e-4) / 2, 1e-10);
  EXPECT_NEAR(run.last("t"), 0.5, 1e-9);
  EXPECT_NEAR(run.last("pull.value"), 1, 1e-9);
  EXPECT_EQ(run.column("t").size(), 4U);
}

// One that acts before it locks saves it.
TEST(KinematicEvents, MayActBeforeItLocks) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {"particle": true, "position": [0.1, 1]}},
    "constraints": [{"type": "absolute_distance", "i": "a", "ground": [0, 0], "value": 1}],
    "drivers": [{"type": "absolute_x", "name": "pull", "i": "a", "value": {"polynomial": [0, 2]}},
                {"type": "absolute_y", "name": "sink", "i": "a", "value": {"polynomial": ["=0.6 + 0.4", -1]}}],
    "outputs": ["a.x", "a.y"],
    "analyses": [{"type": "kinematics", "until": 1, "every": 1, "events": [
      {"when": "=a.y - 1 + t", "direction": "down", "action": "engage", "element": "sink"},
      {"when": "=a.y - 1 + t", "direction": "down", "action": "release", "element": "pull"}]}]})");
  // sqrt(1 - 4 t^2) = 1 - t:  t = 2/5, at (4/5, 3/5); from there on it goes down with 1 m/s.
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  ASSERT_EQ(events_of(run).size(), 2U);
  EXPECT_NEAR(events_of(run)[0].t, 0.4, 1e-12);
  EXPECT_NEAR(run.last("a.y"), 0, 1e-9);
  EXPECT_NEAR(run.last("a.x"), 1, 1e-9);
}

// Measures, reactions and work of the same run with and without events.
TEST(KinematicEvents, ChangeNothingElse) {
  const std::string keys =
      R"("until": 2, "every": 0.5, "outputs": ["crank.to.y", "motor.load", "motor.work", "energy.balance"],
         "measures": {"peak": {"max": "crank.to.y"}, "mean": {"mean": "=motor.load^2"}})";
  const auto scene = [&](const std::string& events) {
    std::string text = crank(events, keys, "inverse_dynamics");
    return text.replace(text.find(R"("catena": 1)"), 11, R"("catena": 1, "gravity": [0, -9.81])");
  };
  const TextRun with = run_text(scene(R"({"when": "crank.to.x", "value": 0.3})")), without = run_text(scene(""));
  ASSERT_EQ(with.outcome.exit_code, 0) << with.outcome.error_text << with.analysis().report.message;
  EXPECT_GT(events_of(with).size(), 0U);
  const std::vector<double> t = with.column("t"), t0 = without.column("t");
  for (const char* name : {"crank.to.y", "motor.load", "motor.work", "energy.balance"}) {
    const std::vector<double> a = with.column(name), b = without.column(name);
    for (std::size_t k = 0; k < t0.size(); ++k) {
      const auto row = std::find(t.begin(), t.end(), t0[k]) - t.begin();
      ASSERT_LT(row, static_cast<std::ptrdiff_t>(t.size()));
      EXPECT_NEAR(a[static_cast<std::size_t>(row)], b[k], 1e-9) << name;
    }
    for (const double value : a) EXPECT_TRUE(std::isfinite(value)) << name;
  }
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(*with.analysis().measures[k].value, *without.analysis().measures[k].value, 1e-9) << k;
}

}  // namespace
}  // namespace catena::testing
