// Where drivers ask for what a driven mechanism cannot do the run ends with a row there, and with the driver's value.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

// 24 seeds.
TEST(LockUpRows, StandAtTheInstantOfTheLockUp) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
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
