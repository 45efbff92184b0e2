// Stacks and walls of many boxes, each on two feet that rub: what lies stays, what falls comes to rest where it
// belongs, and a stack that is pushed ever harder gives way at the instant that statics says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "oracles/scene_text.hpp"
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
    for (const int boxes : {7, 10, 16, 25}) {
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
  for (int n = 0; n < 14; ++n) {
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

/// Rows of boxes, each laid over the gap of two below, on four feet there; all bounce, and have been kicked at random.
std::string bouncing_wall(unsigned seed, int rows, int columns) {
  RandomNumbers random(seed);
  const double e = random(0.1, 0.7), mu = random(0.2, 0.8), drop = random(0, 0.1);
  std::string bodies, forces, outputs;
  const auto touch = [&](const std::string& lower, double y, const std::string& foot) {
    const std::string name = fmt::format("c{}", std::count(forces.begin(), forces.end(), '{') / 3);
    forces += fmt::format(R"({}{{"type": "contact", "name": "{}", "i": "{}", "j": "{}", "mu": {:.17g},
        "restitution": {:.17g}, "curve": {{"line": {{"point": [0, {}], "axis": [1, 0]}}}}}})",
                          forces.empty() ? "" : ", ", name, lower, foot, mu, e, y);
    outputs += fmt::format(R"(, "{}.gap")", name);
  };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c + r < columns; ++c) {
      const std::string name = fmt::format("b{}_{}", r, c);
      const double lift = 0.5 + r + drop * (r + 1) * random(1, 1.2), vx = random(-0.15, 0.15), vy = random(-0.5, 0);
      bodies += fmt::format(R"({}"{}": {{"mass": 1, "inertia": "=1/6", "position": [{}, {:.17g}],
          "velocity": [{:.17g}, {:.17g}], "points": {{"l": [-0.5, -0.5], "m": [0, -0.5], "r": [0.5, -0.5]}}}})",
                            bodies.empty() ? "" : ", ", name, c + 0.5 * r, lift, vx, vy);
      if (r == 0) {
        for (const char* foot : {".l", ".r"}) touch("ground", 0, name + foot);
        continue;
      }
      for (const char* foot : {".l", ".m"}) touch(fmt::format("b{}_{}", r - 1, c), 0.5, name + foot);
      for (const char* foot : {".m", ".r"}) touch(fmt::format("b{}_{}", r - 1, c + 1), 0.5, name + foot);
    }
  }
  return fmt::format(R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{{}}}, "forces": [{}],
    "outputs": ["energy.total", "energy.balance"{}], "analyses": [{{"type": "dynamics", "until": 0.6, "every": 0.05}}]}})",
                     bodies, forces, outputs);
}

// Nothing goes through anything, and energy is lost alone.
TEST(TallStacks, WallsThatBounce) {
  for (const unsigned seed : {1u, 2u, 3u, 6u, 7u}) {
    SCOPED_TRACE(seed);
    const int rows = 2 + static_cast<int>(seed) % 2, columns = rows + static_cast<int>(seed) % 3;
    const TextRun run = run_text(bouncing_wall(seed, rows, columns));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> energy = run.column("energy.total");
    for (std::size_t k = 1; k < energy.size(); ++k) EXPECT_LE(energy[k], energy[k - 1] + 1e-7) << k;
    EXPECT_LT(energy.back(), energy.front() - 0.1);
    EXPECT_NEAR(run.last("energy.balance"), 0, 1e-7);
    const int contacts = 2 * columns + 4 * (rows > 1 ? columns - 1 : 0) + 4 * (rows > 2 ? columns - 2 : 0);
    for (int c = 0; c < contacts; ++c) {
      const std::vector<double> gaps = run.column(fmt::format("c{}.gap", c));
      ASSERT_EQ(gaps.size(), energy.size()) << c;
      EXPECT_GT(*std::min_element(gaps.begin(), gaps.end()), -1e-8) << c;
    }
  }
}

// A chain of links in waves falls on a rough floor: in the end all of its pins lie there.
TEST(TallStacks, ChainsFallFlat) {
  for (const int links : {6, 14, 25}) {
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
