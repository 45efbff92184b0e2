// Derivatives of frequencies where laws of state act, against the roots of a 2 x 2 problem at the equilibrium, which
// moves with the parameters, differenced in long double.
//
//   F_u = -k u + s w - a u w^2 + f        F_w = -c w - r u + h        omega2: eigenvalues of M^-1 (-dF/d(u, w))
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Long = long double;
constexpr std::array<const char*, 9> law_parameters = {"k", "s", "a", "c", "r", "m", "n", "f", "h"};
using Pair = std::array<Long, 9>;
struct Place {
  Long u, w;
};

Place forces_of(const Pair& pair, const Place& at) {
  const auto& [k, s, a, c, r, m, n, f, h] = pair;
  return {-k * at.u + s * at.w - a * at.u * at.w * at.w + f, -c * at.w - r * at.u + h};
}

/// Both omega2 at the equilibrium near a place, the lesser first; complex ones are no numbers.
std::array<Long, 2> roots_of(const Pair& pair, Place at) {
  const auto& [k, s, a, c, r, m, n, f, h] = pair;
  for (int round = 0; round < 30; ++round) {
    const Place force = forces_of(pair, at);
    const Long uu = k + a * at.w * at.w, uw = -s + 2 * a * at.u * at.w, det = uu * c - uw * r;
    at = {at.u + (c * force.u - uw * force.w) / det, at.w + (uu * force.w - r * force.u) / det};
  }
  const Long uu = (k + a * at.w * at.w) / m, uw = (-s + 2 * a * at.u * at.w) / m, wu = r / n, ww = c / n;
  const Long half = (uu + ww) / 2, root = std::sqrt((uu - ww) * (uu - ww) / 4 + uw * wu);
  return {half - root, half + root};
}

std::string scene_of(const Pair& pair, const Place& at) {
  std::string numbers, names;
  for (std::size_t p = 0; p < pair.size(); ++p) {
    numbers +=
        (p > 0 ? ", \"" : "\"") + std::string(law_parameters[p]) + "\": " + text_of(static_cast<double>(pair[p]));
    names += (p > 0 ? ", \"" : "\"") + std::string(law_parameters[p]) + "\"";
  }
  const auto particle = [](const char* mass, Long x) {
    return R"({"mass": "=)" + std::string(mass) + R"(", "particle": true, "position": [)" +
           text_of(static_cast<double>(x)) + ", 0]}";
  };
  return R"({"catena": 1, "parameters": {)" + numbers + R"(}, "bodies": {"u": )" + particle("m", at.u) + R"(, "w": )" +
         particle("n", at.w) + R"(}, "constraints": [{"type": "absolute_y", "i": "u", "value": 0},
      {"type": "absolute_y", "i": "w", "value": 0}],
    "forces": [{"type": "point_force", "i": "u", "force": ["=-k*u.x + s*w.x - a*u.x*w.x^2 + f", 0]},
               {"type": "point_force", "i": "w", "force": ["=-c*w.x - r*u.x + h", 0]}],
    "analyses": [{"type": "sensitivity", "parameters": [)" +
         names + R"(], "of": {"type": "modes", "measures": {"low": {"field": "omega2[1]"}, "high": {"field":
      "omega2[2]"}}}}]})";
}

TEST(LawFrequencies, OfTwoWeightsThatPullEachOtherByLaws) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const std::array<std::array<double, 2>, 7> range = {
        {{10, 20}, {0.5, 4}, {1, 5}, {40, 80}, {-2, 4}, {0.5, 2}, {0.5, 1}}};
    Pair pair{};
    for (std::size_t p = 0; p < range.size(); ++p) pair[p] = random(range[p][0], range[p][1]);
    Place at{};
    at.u = random(-0.5, 0.5);
    at.w = random(0.2, 0.8);
    const Place rest = forces_of(pair, at);
    pair[7] = static_cast<double>(-rest.u);
    pair[8] = static_cast<double>(-rest.w);
    const std::array<Long, 2> roots = roots_of(pair, at);
    const TextRun run = run_text(scene_of(pair, at));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const std::array<const char*, 2> names = {"low", "high"};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto root = static_cast<double>(roots[i]);
      EXPECT_NEAR(value(run, names[i]), root, 1e-11 * root) << names[i];
      for (std::size_t p = 0; p < pair.size(); ++p) {
        const Long step = 1e-4L * std::max(std::abs(pair[p]), Long(0.1L));
        const auto moved = [&](Long by) {
          Pair other = pair;
          other[p] += by;
          return roots_of(other, at)[i];
        };
        const auto slope = static_cast<double>(
            (8 * (moved(step) - moved(-step)) - (moved(2 * step) - moved(-2 * step))) / (12 * step));
        EXPECT_NEAR(gradient(run, names[i], p), slope, 1e-10 * std::max(std::abs(slope), root))
            << names[i] << " " << law_parameters[p];
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 12 * 18);
}

}  // namespace
}  // namespace catena::testing
