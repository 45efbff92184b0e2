// Many events within one step: each at the instant of a closed form, in order, also where one in between changes the
// motion and those behind it are met later than they were foreseen.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

// x = 2 t, from 0.5 s on 1 + v (t - 0.5) after a blow; y = 3 t - 4 t^2, which comes back. 6 seeds of 300 events.
TEST(EventBatches, EachAtItsInstant) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
    const double v = draw(0.5, 4);
    std::vector<std::pair<double, std::string>> expected{{0.5, "blow"}};
    std::string events = R"({"name": "blow", "when": "t", "value": 0.5, "impulse": {"i": "p", "value": [)" +
                         fmt::format("{:.17g}", v - 2) + ", 0]}}";
    for (int k = 0; k < 300; ++k) {
      const bool across = k % 2 == 0;
      const double value = across ? draw(0.01, 0.99 + v / 2) : draw(-0.9, 0.55);
      const std::string name = fmt::format("e{}", k);
      events += fmt::format(R"(, {{"name": "{}", "when": "p.{}", "value": {:.17g}}})", name, across ? "x" : "y", value);
      if (across) {
        expected.emplace_back(value < 1 ? value / 2 : 0.5 + (value - 1) / v, name);
        continue;
      }
      const double root = std::sqrt(9 - 16 * value);
      for (const double t : {(3 - root) / 8, (3 + root) / 8}) {
        if (t > 0 && t < 1) expected.emplace_back(t, name);
      }
    }
    std::sort(expected.begin(), expected.end());
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -8], "bodies": {"p": {"particle": true, "mass": 1,
        "position": [0, 0], "velocity": [2, 3]}}, "analyses": [{"type": "dynamics", "until": 1, "every": 1,
        "tolerance": 1e-11, "events": [)" +
                                 events + "]}]}");
    ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
    const std::vector<EventEntry> found = events_of(run);
    ASSERT_EQ(found.size(), expected.size()) << seed;
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].name, expected[k].second) << seed << " " << k;
      EXPECT_NEAR(found[k].t, expected[k].first, 1e-10) << seed << " " << found[k].name;
    }
  }
}

}  // namespace
}  // namespace catena::testing
