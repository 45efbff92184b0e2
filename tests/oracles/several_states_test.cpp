// Two blocks on each other, pulled from rest, friction at rest above that in motion: the states of friction that meet
// all equations and limits are counted here, each from its own closed form,
//
//   m1 a1 = P + T1 - T2,   m2 a2 = F + T2      T1 on the lower block from the floor, T2 on the upper one from the lower
//
// The run takes one in which as many places stick as can, and tells where another one would have fitted as well.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

constexpr double g = 10, duration = 0.1;
// A case nearer to a limit than this part of the loads is not judged.
constexpr double clear = 1e-4;

struct Stack {
  double m1, m2, mu1, mu2, static1, static2, P, F;
};

Stack random_stack(unsigned seed) {
  RandomNumbers draw(seed);
  Stack s{};
  s.m1 = draw(0.3, 3);
  s.m2 = draw(0.3, 3);
  s.mu1 = draw(0.05, 0.5);
  s.mu2 = draw(0.05, 0.9);
  s.static1 = s.mu1 * draw(1, 3);
  s.static2 = s.mu2 * draw(1, 3);
  const double weight = (s.m1 + s.m2) * g;
  s.P = draw(0, 1) < 0.5 ? 0 : draw(-1, 1) * weight;
  s.F = draw(-1, 1) * weight;
  return s;
}

struct Motion {
  int sticking;
  double a1, a2;
};

/// What fits; `unclear`: some state is too near to a limit to be judged.
std::vector<Motion> motions_that_fit(const Stack& s, bool& unclear) {
  const double n1 = (s.m1 + s.m2) * g, n2 = s.m2 * g, size = n1 + std::abs(s.P) + std::abs(s.F);
  std::vector<Motion> found;
  for (const int floor : {0, 1, -1}) {
    for (const int deck : {0, 1, -1}) {
      double a1 = 0, a2 = 0, T1 = 0, T2 = 0;
      if (floor != 0) T1 = -floor * s.mu1 * n1;
      if (deck != 0) T2 = -deck * s.mu2 * n2;
      if (deck == 0) {
        a1 = a2 = floor == 0 ? 0 : (s.P + s.F + T1) / (s.m1 + s.m2);
        T2 = s.m2 * a2 - s.F;
        if (floor == 0) T1 = T2 - s.P;
      } else {
        a2 = (s.F + T2) / s.m2;
        if (floor == 0) T1 = T2 - s.P;
        if (floor != 0) a1 = (s.P + T1 - T2) / s.m1;
      }
      // How far each condition is from its limit, N; a slide goes the way it is meant to.
      const double first = floor == 0 ? s.static1 * n1 - std::abs(T1) : floor * a1 * s.m1;
      const double second = deck == 0 ? s.static2 * n2 - std::abs(T2) : deck * (a2 - a1) * s.m2;
      unclear |= std::min(std::abs(first), std::abs(second)) < clear * size;
      if (first > 0 && second > 0) found.push_back({(floor == 0) + (deck == 0), a1, a2});
    }
  }
  return found;
}

std::string stack_text(const Stack& s) {
  const auto contact = [](const char* name, const char* i, const char* j, double height, double mu, double mu_static) {
    return fmt::format(R"({{"type": "contact", "name": "{}", "i": "{}", "j": ["{}", [0, -0.5]], "mu": {:.17g},
 "mu_static": {:.17g}, "curve": {{"line": {{"point": [0, {}], "axis": [1, 0]}}}}}})",
                       name, i, j, mu, mu_static, height);
  };
  return fmt::format(
      R"({{"catena": 1, "gravity": [0, {}], "bodies": {{
 "lower": {{"mass": {:.17g}, "inertia": 1, "position": [0, 0.5]}},
 "upper": {{"mass": {:.17g}, "inertia": 1, "position": [0, 1.5]}}}},
 "constraints": [{{"type": "absolute_angle", "i": "lower", "value": 0}},
                 {{"type": "absolute_angle", "i": "upper", "value": 0}}],
 "forces": [{}, {}, {{"type": "point_force", "i": "lower", "force": [{:.17g}, 0]}},
            {{"type": "point_force", "i": "upper", "force": [{:.17g}, 0]}}],
 "outputs": ["lower.x", "upper.x"], "analyses": [{{"type": "dynamics", "at": [{}]}}]}})",
      -g, s.m1, s.m2, contact("floor", "ground", "lower", 0, s.mu1, s.static1),
      contact("deck", "lower", "upper", 0.5, s.mu2, s.static2), s.P, s.F, duration);
}

bool tells_of_several(const TextRun& run) {
  const std::vector<std::string>& warnings = run.analysis().report.warnings;
  return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
    return warning.find("friction leaves open what moves") != std::string::npos;
  });
}

struct Seen {
  int judged = 0, several = 0;
};

std::string stack_fault(unsigned seed, Seen& seen) {
  const Stack stack = random_stack(seed);
  bool unclear = false;
  const std::vector<Motion> fitting = motions_that_fit(stack, unclear);
  if (unclear) return {};
  const TextRun run = run_text(stack_text(stack));
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  ++seen.judged;
  int most = 0;
  for (const Motion& motion : fitting) most = std::max(most, motion.sticking);
  const auto rivals =
      std::count_if(fitting.begin(), fitting.end(), [&](const Motion& m) { return m.sticking == most; });
  seen.several += rivals > 1;
  const double part = duration * duration / 2;
  const auto is_taken = [&](const Motion& m) {
    return m.sticking == most && std::abs(run.last("lower.x") - m.a1 * part) < 1e-9 &&
           std::abs(run.last("upper.x") - m.a2 * part) < 1e-9;
  };
  if (std::none_of(fitting.begin(), fitting.end(), is_taken))
    return fmt::format("moves by {} and {}, which none of {} states explains in which {} places stick",
                       run.last("lower.x"), run.last("upper.x"), rivals, most);
  if (tells_of_several(run) != (rivals > 1))
    return fmt::format("{} states fit, told: {}", rivals, tells_of_several(run));
  return {};
}

TEST(StatesOfFriction, OfStacksAreToldWhereSeveralFit) {
  Seen seen;
  const int usual = size_of_test(400, 100);
  expect_no_fault(first_case(), last_case(usual), [&](unsigned seed) { return stack_fault(seed, seen); });
  std::printf("%d judged, of %d several states fit\n", seen.judged, seen.several);
  EXPECT_GT(seen.judged, stress_cases(usual) / 2);
  EXPECT_GT(seen.several, stress_cases(usual) / 100);
}

// The names in the note on shared friction are those of the scene.
TEST(StatesOfFriction, SharedByTwoFeetNameTheFeet) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [1, -9.81],
 "bodies": {"box": {"mass": 2, "inertia": 0.3, "position": [0, 0.5], "points": {"l": [-0.5, -0.5], "r": [0.5, -0.5]}}},
 "forces": [{"type": "contact", "name": "L", "i": "ground", "j": "box.l", "mu": 0.4,
             "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}},
            {"type": "contact", "name": "R", "i": "ground", "j": "box.r", "mu": 0.4,
             "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}],
 "outputs": ["L.friction", "R.friction", "L.force"], "analyses": [{"type": "dynamics", "at": [0, 1]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  std::string all;
  for (const std::string& warning : run.analysis().report.warnings) all += warning;
  EXPECT_NE(all.find("\"L (friction)\", \"R (friction)\" are not unique"), std::string::npos) << all;
  // The least of all shares: as much on each.
  EXPECT_NEAR(run.last("L.friction"), -1, 1e-9);
  EXPECT_NEAR(run.last("R.friction"), -1, 1e-9);
  EXPECT_NEAR(run.last("L.force"), 9.81 - 1, 1e-9);
}

}  // namespace
}  // namespace catena::testing
