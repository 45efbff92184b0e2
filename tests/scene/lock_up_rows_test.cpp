// Where drivers ask for what a driven mechanism cannot do the run ends with a row there, and with the driver's value.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/sanitized.hpp"
#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

struct LockUp {
  double t = std::nan(""), value = std::nan("");
  std::string driver;
};

LockUp lock_up_of(const TextRun& run) {
  LockUp lock_up;
  for (const FieldRecord& record : records_of(run, "singular")) {
    for (const auto& [key, value] : record) {
      if (key == "t") lock_up.t = std::get<double>(value);
      if (key == "value") lock_up.value = std::get<double>(value);
      if (key == "driver") lock_up.driver = std::get<std::string>(value);
    }
  }
  return lock_up;
}

/// A particle on a circle of this radius, drawn to the right from x0 by `speed`: it locks at (radius - x0) / speed.
std::string ball(const std::string& name, double radius, double x0) {
  return fmt::format(R"("{0}": {{"particle": true, "mass": 1, "position": [{1:.17g}, {2:.17g}]}})", name, x0,
                     std::sqrt(radius * radius - x0 * x0));
}
std::string ring(const std::string& name, double radius) {
  return fmt::format(R"({{"type": "absolute_distance", "i": "{}", "ground": [0, 0], "value": {:.17g}}})", name, radius);
}
std::string pull(const std::string& name, double x0, double speed) {
  return fmt::format(
      R"({{"type": "absolute_x", "name": "pull {0}", "i": "{0}", "value": {{"polynomial": [{1:.17g}, {2:.17g}]}}}})",
      name, x0, speed);
}

TextRun run_one(const std::string& analysis, double radius, double x0, double speed) {
  return run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + ball("a", radius, x0) +
                  R"(}, "constraints": [)" + ring("a", radius) + R"(], "drivers": [)" + pull("a", x0, speed) +
                  R"(], "outputs": ["a.x", "a.y", "a.vy", "pull a.value"], "analyses": [)" + analysis + "]}");
}

TEST(LockUpRows, StandAtTheInstantOfTheLockUp) {
  for (unsigned seed = 1; seed <= size_of_test(24u, 8u); ++seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
    const double radius = draw(0.3, 3), x0 = radius * draw(-0.9, 0.9), speed = draw(0.2, 4);
    const double lock = (radius - x0) / speed;
    const std::vector<std::string> analyses{R"("type": "kinematics")",
                                            R"("type": "inverse_dynamics")",
                                            R"("type": "dynamics")",
                                            R"("type": "dynamics", "method": "rk5")",
                                            R"("type": "dynamics", "method": "adams")",
                                            R"("type": "dynamics", "method": "baumgarte")",
                                            R"("type": "dynamics", "method": "partitioning")"};
    for (const std::string& analysis : analyses) {
      const TextRun run = run_one(
          fmt::format(R"({{{}, "until": {:.17g}, "every": {:.17g}}})", analysis, 2 * lock, draw(0.1, 0.9) * lock),
          radius, x0, speed);
      const std::string what = fmt::format("seed {}: {}: {}", seed, analysis, run.analysis().report.message);
      EXPECT_EQ(run.analysis().report.status, Status::lock_up) << what;
      const LockUp told = lock_up_of(run);
      EXPECT_NEAR(told.t, lock, 1e-7 * lock) << what;
      EXPECT_EQ(told.driver, "pull a") << what;
      EXPECT_NEAR(told.value, radius, 1e-7 * radius) << what;
      EXPECT_EQ(run.last("t"), told.t) << what;
      EXPECT_NEAR(run.last("pull a.value"), radius, 1e-7 * radius) << what;
      EXPECT_NEAR(run.last("a.x"), radius, 1e-7 * radius) << what;
      EXPECT_NEAR(run.last("a.y"), 0, 1e-4 * radius) << what;
      EXPECT_FALSE(std::isfinite(run.last("a.vy"))) << what;
    }
  }
}

// Two rods that are pulled straight, whose energies and work grow without bound on the way there: it is the dead point
// that is told, whatever is looked at, and rows before it have their work.
TEST(LockUpRows, WhereWorkIsSummedUp) {
  const std::string bodies = R"({"catena": 1, "bodies": {
      "c": {"rod": {"from": [0, 0], "to": [0.18, 0.24]}, "mass": 1},
      "r": {"rod": {"from": [0.18, 0.24], "to": [0.5, 0]}, "mass": 1}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "c.from"}, {"type": "revolute", "i": "c.to", "j": "r.from"},
      {"type": "absolute_y", "i": "r.to", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "pull", "i": "r.to", "value": {"polynomial": [0.5, )";
  for (const std::string type : {"inverse_dynamics", "dynamics"}) {
    for (const double rate : is_sanitized ? std::vector{0.1, 7.0} : std::vector{0.01, 0.1, 0.3, 1.0, 7.0}) {
      for (const std::string outputs : {R"("pull.work")", R"("energy")", R"("pull.load")"}) {
        SCOPED_TRACE(type + " " + outputs + " " + std::to_string(rate));
        const double end = 0.2 / rate;
        const TextRun run = run_text(bodies + std::to_string(rate) + R"(]}}], "outputs": ["c.angle", "pull.value", )" +
                                     outputs + R"(], "analyses": [{"type": ")" + type + R"(", "until": )" +
                                     std::to_string(2 * end) + R"(, "every": )" + std::to_string(end / 4) + "}]}");
        EXPECT_EQ(run.analysis().report.status, Status::lock_up) << run.analysis().report.message;
        EXPECT_NEAR(run.last("t"), end, 1e-8 * end);
        EXPECT_NEAR(run.last("pull.value"), 0.7, 1e-8);
        EXPECT_NEAR(run.last("c.angle"), 0, 1e-5);
        EXPECT_EQ(lock_up_of(run).driver, "pull");
        if (outputs != R"("pull.work")") continue;
        // All work is kinetic energy: of the first rod, and of the second about its end on the rail.
        const std::vector<double> work = run.column("pull.work"), x = run.column("pull.value");
        EXPECT_TRUE(std::isnan(work.back()));
        const auto kinetic = [&](double reach) {
          const double first = std::acos((0.09 + reach * reach - 0.16) / (0.6 * reach));
          const double second = -std::asin(0.3 * std::sin(first) / 0.4);
          // reach = 0.3 cos first + 0.4 cos second, and 0.3 sin first + 0.4 sin second = 0.
          const double det = 0.3 * 0.4 * std::sin(second - first);
          const double turn = rate * 0.4 * std::cos(second) / det, swing = -rate * 0.3 * std::cos(first) / det;
          const double vx = -0.3 * std::sin(first) * turn - 0.2 * std::sin(second) * swing;
          const double vy = 0.3 * std::cos(first) * turn + 0.2 * std::cos(second) * swing;
          return 0.09 / 6 * turn * turn + (vx * vx + vy * vy) / 2 + 0.16 / 24 * swing * swing;
        };
        for (std::size_t k = 0; k + 1 < work.size(); ++k)
          EXPECT_NEAR(work[k], kinetic(x[k]) - kinetic(0.5), 1e-7 * rate * rate) << k;
      }
    }
  }
}

// A driver that rests where the mechanism is singular: it is told with the value that it has there, not beside it.
TEST(LockUpRows, WhereTheDriverRests) {
  for (const double speed : {0.5, 2.0, 30.0}) {
    const TextRun run =
        run_text(R"({"catena": 1, "bodies": {)" + ball("a", 1, 0) + R"(}, "constraints": [)" + ring("a", 1) +
                 fmt::format(R"(], "drivers": [{{"type": "absolute_x", "name": "push",
      "i": "a", "value": {{"harmonic": {{"amplitude": 1, "omega": {0:.17g}}}}}}}], "outputs": ["a.y"],
      "analyses": [{{"type": "kinematics", "until": {1:.17g}, "every": {1:.17g}}}]}})",
                             speed, 2.4 / speed));
    EXPECT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
    EXPECT_NEAR(lock_up_of(run).t, std::acos(0.0) / speed, 1e-7 / speed);
    EXPECT_EQ(lock_up_of(run).driver, "push");
    EXPECT_NEAR(lock_up_of(run).value, 1, 1e-12);
    EXPECT_NEAR(run.last("a.y"), std::cos(2.4), 1e-8);
  }
}

// In a phase that an event began, and with an event on the way.
TEST(LockUpRows, AfterAnEvent) {
  for (const std::string type : {"kinematics", "dynamics"}) {
    const TextRun run =
        run_text(R"({"catena": 1, "bodies": {)" + ball("a", 1, 0) + R"(}, "constraints": [)" + ring("a", 1) +
                 R"(], "drivers": [)" + pull("a", 0, 1) +
                 R"(, {"type": "absolute_x", "name": "fast", "i": "a", "value": {"polynomial": [-1, 3]}}],
      "outputs": ["a.x", "fast.value"],
      "analyses": [{"type": ")" +
                 type + R"(", "until": 2, "every": 2, "events": [
        {"name": "on", "when": "t", "value": 0.5, "action": "engage", "element": "fast"},
        {"name": "off", "when": "t", "value": 0.5, "action": "release", "element": "pull a"},
        {"name": "near", "when": "a.x", "value": 0.8}]}]})");
    EXPECT_EQ(run.analysis().report.status, Status::lock_up) << run.analysis().report.message;
    EXPECT_NEAR(run.last("t"), 2 / 3., 1e-8) << type;
    EXPECT_NEAR(run.last("a.x"), 1, 1e-8) << type;
    EXPECT_NEAR(run.last("fast.value"), 1, 1e-8) << type;
    EXPECT_EQ(lock_up_of(run).driver, "fast");
    const std::vector<EventEntry> events = events_of(run);
    ASSERT_EQ(events.size(), 3U) << type;
    EXPECT_NEAR(events[2].t, 0.6, 1e-9) << type;
  }
}

}  // namespace
}  // namespace catena::testing
