// `find`: all places of rest of what slides on a line under springs, against the roots of the force along it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct Spring {
  double x, y, k, length;
};

/// The force along the line y = 0 at x, N.
double force_at(const std::vector<Spring>& springs, double x) {
  double force = 0;
  for (const Spring& spring : springs) {
    const double dx = spring.x - x, distance = std::hypot(dx, spring.y);
    force += spring.k * (distance - spring.length) * dx / distance;
  }
  return force;
}

/// Stable places, where the force turns from pushing on to pushing back, ascending.
std::vector<double> stable_places(const std::vector<Spring>& springs) {
  constexpr int parts = 40000;
  constexpr double end = 8;
  std::vector<double> found;
  for (int n = 0; n < parts; ++n) {
    double a = -end + 2 * end * n / parts, b = -end + 2 * end * (n + 1) / parts;
    if (!(force_at(springs, a) > 0 && force_at(springs, b) <= 0)) continue;
    for (int bisection = 0; bisection < 60; ++bisection) {
      const double middle = (a + b) / 2;
      (force_at(springs, middle) > 0 ? a : b) = middle;
    }
    found.push_back(a);
  }
  return found;
}

/// `body`: its entry in the scene; `hold`: what keeps it on the line.
TextRun run_slider(const std::string& body, const std::string& hold, const std::vector<Spring>& springs) {
  std::string forces;
  for (const Spring& spring : springs) {
    forces +=
        fmt::format(R"({}{{"type": "spring_damper", "i": ["ground", [{}, {}]], "j": "p", "k": {}, "length": {}}})",
                    forces.empty() ? "" : ", ", spring.x, spring.y, spring.k, spring.length);
  }
  return run_text(fmt::format(R"({{"catena": 1, "gravity": [0, 0], "bodies": {{"p": {{"mass": 1, {}}}}},
    "constraints": [{}], "forces": [{}], "outputs": ["p.x", "p.angle"],
    "analyses": [{{"type": "equilibrium", "find": 20, "accept": "stable"}}]}})",
                              body, hold, forces));
}

std::string difference(const TextRun& run, const std::vector<double>& expected, double tolerance) {
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  std::vector<double> places = run.column("p.x");
  std::sort(places.begin(), places.end());
  if (places.size() != expected.size()) return fmt::format("{} places, not {}", places.size(), expected.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (!(std::abs(places[k] - expected[k]) < tolerance)) return fmt::format("{}, not {}", places[k], expected[k]);
  }
  for (const double angle : run.column("p.angle")) {
    if (!(std::abs(angle) < 1e-9)) return fmt::format("turned by {} rad", angle);
  }
  return {};
}

const std::string particle = R"("particle": true, "position": [0.5, 0])";
const std::string slide = R"("inertia": 1, "position": [0.5, 0])";
const std::string on_a_line = R"({"type": "absolute_y", "i": "p", "value": 0})";
const std::string in_a_guide = R"({"type": "translational", "i": "ground", "j": "p", "axis_i": [1, 0]})";

// A spring of 1.2 m whose foot is 1 m beside the line: the two ways in which it can snap, mirror images.
TEST(SeveralEquilibria, BothWellsOfABistableSlider) {
  const std::vector<Spring> springs = {{0, 1, 100, 1.2}};
  const double well = std::sqrt(1.2 * 1.2 - 1);
  EXPECT_EQ(difference(run_slider(particle, on_a_line, springs), {-well, well}, 1e-8), "");
  EXPECT_EQ(difference(run_slider(slide, in_a_guide, springs), {-well, well}, 1e-8), "");
}

TEST(SeveralEquilibria, OfRandomSlidersAreTheRootsOfTheForce) {
  expect_no_fault(1, size_of_test(60u, 10u), [](unsigned seed) {
    RandomNumbers random(seed);
    std::vector<Spring> springs(1 + seed % 3);
    for (Spring& spring : springs) {
      spring.x = random(-1.5, 1.5);
      spring.y = random(0.2, 1.2) * (seed % 2 == 0 ? 1 : -1);
      spring.k = random(50, 300);
      spring.length = random(0.3, 2.2);
    }
    const bool guided = seed % 4 < 2;
    const TextRun run = run_slider(guided ? slide : particle, guided ? in_a_guide : on_a_line, springs);
    return difference(run, stable_places(springs), 1e-7);
  });
}

// A pendulum that hangs from a slide between two springs stands on either side of where its own spring is strained: no
// answer has the slide turned over in its guide.
TEST(SeveralEquilibria, SlidesAreNotTurnedOver) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, 0],
    "bodies": {"p": {"mass": 1, "inertia": 1, "position": [0.2, 0]},
               "r": {"mass": 1, "inertia": 1, "position": [0.2, -0.5], "points": {"tip": [0, -0.5]}}},
    "constraints": [{"type": "translational", "i": "ground", "j": "p", "axis_i": [1, 0]},
                    {"type": "revolute", "i": "p", "j": "r", "at": [0.2, 0]}],
    "forces": [{"type": "spring_damper", "i": ["ground", [0, 1]], "j": "p", "k": 100, "length": 1.2},
               {"type": "torsion_spring", "i": "p", "j": "r", "k": 5}],
    "outputs": ["p.x", "p.angle", "r.angle"],
    "analyses": [{"type": "equilibrium", "find": 4, "accept": "stable"}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  ASSERT_EQ(run.column("p.x").size(), 2U);
  for (const double x : run.column("p.x")) EXPECT_NEAR(std::abs(x), std::sqrt(1.2 * 1.2 - 1), 1e-8);
  for (const double angle : run.column("p.angle")) EXPECT_NEAR(angle, 0, 1e-9);
}

}  // namespace
}  // namespace catena::testing
