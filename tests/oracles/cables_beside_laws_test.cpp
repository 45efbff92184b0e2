// Equilibria of a particle that elastic cables and a spring hold beside a law of its place: places that balance, to
// rounding, of forces without a potential.
//
//   m g + law(r) + sum k_i (l_i - L_i) u_i = 0,   law = (3 sin 2y, 2x) N,   a cable pulls alone
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string fault_of(unsigned seed) {
  RandomNumbers random(seed);
  const double mass = random(0.5, 2), gravity = random(0, 10);
  double fx[4], fy[4], stiffness[4], length[4];
  std::string forces;
  for (int k = 0; k < 4; ++k) {
    const double angle = random(0, 6.283), radius = random(0.6, 1.6), part = random(0.7, 1.3);
    fx[k] = radius * std::cos(angle);
    fy[k] = -1 + radius * std::sin(angle);
    stiffness[k] = std::pow(10.0, random(1, 2.3));
    length[k] = radius * part;
    forces += std::string(R"({"type": ")") + (k < 3 ? "cable" : "spring_damper") + R"(", "i": ["ground", [)" +
              text_of(fx[k]) + ", " + text_of(fy[k]) + R"(]], "j": "b", "k": )" + text_of(stiffness[k]) +
              R"(, "length": )" + text_of(length[k]) + "},";
  }
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, )" + text_of(-gravity) +
                               R"(], "bodies": {"b": {"particle": true, "mass": )" + text_of(mass) +
                               R"(, "position": [0, -1]}}, "forces": [)" + forces +
                               R"json({"type": "point_force", "i": "b", "force": ["=3*sin(2*b.y)", "=2*b.x"]}],
      "outputs": ["b.x", "b.y"], "analyses": [{"type": "equilibrium"}]
})json");
  const Report& report = run.analysis().report;
  if (!report.ok()) return std::string(to_string(report.status)) + ": " + report.message;
  const double x = run.last("b.x"), y = run.last("b.y");
  double sum[2] = {3 * std::sin(2 * y), 2 * x - mass * gravity}, largest = mass * gravity;
  for (int k = 0; k < 4; ++k) {
    const double dx = x - fx[k], dy = y - fy[k], l = std::hypot(dx, dy);
    if (k < 3 && l <= length[k]) continue;
    const double pull = stiffness[k] * (l - length[k]);
    largest = std::max(largest, std::abs(pull));
    sum[0] -= pull * dx / l;
    sum[1] -= pull * dy / l;
  }
  const double left = std::hypot(sum[0], sum[1]);
  return left <= 1e-10 * largest + 1e-12 ? "" : text_of(left) + " N are left of " + text_of(largest);
}

// Among these seeds are four whose last step but one passes by the solver's measure of the forces, and not by the
// judge's.
TEST(CablesBesideLaws, BalanceToRounding) {
  expect_no_fault(255, 300, fault_of);
  expect_no_fault(350, 370, fault_of);
  expect_no_fault(730, 750, fault_of);
}

}  // namespace
}  // namespace catena::testing
