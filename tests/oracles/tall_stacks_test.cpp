// Stacks and walls of many boxes, each on two feet that rub: what lies stays, what falls comes to rest where it
// belongs, and a stack that is pushed ever harder gives way at the instant that statics says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/sanitized.hpp"
#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81;

/// Boxes of mass 1 and width and height one; the lowest gap is `drop`, and each one above has as much more.
std::string stack(int boxes, double mu, double drop, const std::string& more, const std::string& analysis) {
  std::string bodies, forces, outputs;
  for (int k = 0; k < boxes; ++k) {
    bodies += fmt::format(
        R"({}"b{}": {{"mass": 1, "inertia": "=1/6", "position": [0, {:.17g}], "points": {{"l": [-0.5, -0.5], "r": [0.5, -0.5]}}}})",
        k > 0 ? ", " : "", k, k + 0.5 + drop * (k + 1));
    const std::string below = k == 0 ? R"("ground")" : fmt::format(R"("b{}")", k - 1);
    for (const char* foot : {"l", "r"})
      forces += fmt::format(
          R"({}{{"type": "contact", "name": "{}{}", "i": {}, "j": "b{}.{}", "mu": {:.17g},
             "curve": {{"line": {{"point": [0, {}], "axis": [1, 0]}}}}}})",
          forces.empty() ? "" : ", ", foot, k, below, k, foot, mu, k == 0 ? 0 : 0.5);
    outputs += fmt::format(R"({}"b{}.x", "b{}.y")", k > 0 ? ", " : "", k, k);
  }
  return fmt::format(R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{{}}}, "forces": [{}{}], "outputs": [{}],
    "analyses": [{{"type": "dynamics", {}}}]}})",
                     bodies, forces, more, outputs, analysis);
}

TEST(TallStacks, LieAndFallToRest) {
  for (const double drop : {0.0, 0.03}) {
    for (const int boxes : {7, 10, size_of_test(16, 8), size_of_test(25, 9)}) {
      SCOPED_TRACE(boxes);
      const TextRun run = run_text(stack(boxes, 0.4, drop, "", R"("until": 1, "every": 0.5, "tolerance": 1e-9)"));
      ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
      for (int k = 0; k < boxes; ++k) {
        EXPECT_NEAR(run.last(fmt::format("b{}.y", k)), k + 0.5, 1e-9);
        EXPECT_NEAR(run.last(fmt::format("b{}.x", k)), 0, 1e-9);
      }
    }
  }
}

// A force c t on box k: the boxes from j on tip about an edge at c t (k - j + 1/2) = (n - j) g/2 and slide at
// c t = mu (n - j) g, j <= k.
TEST(TallStacks, GiveWayWhenStaticsSays) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(0, 1);
  for (int n = 0; n < size_of_test(14, 6); ++n) {
    SCOPED_TRACE(n);
    const int boxes = 5 + n, k = static_cast<int>(number(engine) * boxes);
    const double mu = n % 2 == 0 ? 0.9 : 0.02 + 0.1 * number(engine), rate = 1000;
    double least = mu * (boxes - k) * g;
    for (int j = 0; j <= k; ++j) least = std::min(least, (boxes - j) * g / 2 / (k - j + 0.5));
    const double until = 1.05 * least / rate;
    const TextRun run = run_text(stack(
        boxes, mu, 0,
        fmt::format(R"(, {{"type": "point_force", "i": ["b{}", [0, 0]], "force": [{{"polynomial": [0, {}]}}, 0]}})", k,
                    rate),
        fmt::format(R"("until": {:.17g}, "every": {:.17g}, "tolerance": 1e-10)", until, until)));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    const std::vector<EventEntry> events = events_of(run);
    ASSERT_FALSE(events.empty());
    EXPECT_NEAR(events.front().t, least / rate, 1e-9 * until);
    EXPECT_GT(run.last(fmt::format("b{}.x", k)), 1e-12);
  }
}

// A chain of links in waves falls on a rough floor: in the end all of its pins lie there.
TEST(TallStacks, ChainsFallFlat) {
  for (const int links : {size_of_test(6, 4), size_of_test(14, 6)}) {
    SCOPED_TRACE(links);
    const double l = 0.1;
    double x = 0, y = 0.05;
    std::string bodies, joints, floors, outputs;
    for (int k = 0; k < links; ++k) {
      const double angle = 0.2 * std::sin(0.7 * k), dx = l * std::cos(angle), dy = l * std::sin(angle);
      bodies += fmt::format(
          R"({}"b{}": {{"mass": 0.1, "inertia": "=0.1*0.01/12", "position": [{:.17g}, {:.17g}], "angle": {:.17g},
             "points": {{"f": [-0.05, 0], "t": [0.05, 0]}}}})",
          k > 0 ? ", " : "", k, x + dx / 2, y + dy / 2, angle);
      if (k > 0)
        joints += fmt::format(R"({}{{"type": "revolute", "i": "b{}.t", "j": "b{}.f"}})", k > 1 ? ", " : "", k - 1, k);
      floors += fmt::format(R"({{"type": "contact", "i": "ground", "j": "b{}.t", "mu": 0.4,
             "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}, )",
                            k);
      outputs += fmt::format(R"({}"b{}.t.y")", k > 0 ? ", " : "", k);
      x += dx, y += dy;
    }
    const TextRun run = run_text(fmt::format(
        R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{{}}}, "constraints": [{}], "forces": [{}{{"type": "contact",
           "i": "ground", "j": "b0.f", "mu": 0.4, "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}],
           "outputs": [{}], "analyses": [{{"type": "dynamics", "until": 1.5, "every": 1.5}}]}})",
        bodies, joints, floors, outputs));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    for (int k = 0; k < links; ++k) EXPECT_NEAR(run.last(fmt::format("b{}.t.y", k)), 0, 1e-9);
  }
}

}  // namespace
}  // namespace catena::testing
