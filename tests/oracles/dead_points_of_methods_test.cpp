// Dynamics that drivers lead to a dead point: every method ends there, with the same status, at the same instant.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// The slider of a slider-crank is driven outwards until crank and rod lie in line: r + l = x0 + v t.
TEST(DeadPointsOfMethods, AreThoseOfTheMechanism) {
  expect_no_fault(1, 48, [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double r = random(0.2, 0.5), l = r * random(1.2, 3), angle = random(0.3, 1.5), v = random(0.1, 2);
    const double x = r * std::cos(angle), y = r * std::sin(angle), slider = x + std::sqrt(l * l - y * y);
    const double instant = (r + l - slider) / v;
    const char* const methods[] = {"rk8", "rk5", "adams", "radau", "alpha", "rattle"};
    const std::string method = methods[seed % 6];
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
          "crank": {"rod": {"from": [0, 0], "to": )" +
        pair_of(x, y) + R"(}, "mass": 1}, "rod": {"rod": {"from": )" + pair_of(x, y) + R"(, "to": )" +
        pair_of(slider, 0) + R"(}, "mass": 1}, "block": {"mass": 1, "inertia": 0.1, "position": )" +
        pair_of(slider, 0) + R"(}},
        "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"},
          {"type": "revolute", "i": "crank.to", "j": "rod.from"}, {"type": "revolute", "i": "rod.to", "j": "block"},
          {"type": "translational", "i": "ground", "j": "block", "axis_i": [1, 0]}],
        "drivers": [{"type": "absolute_x", "i": "block", "value": {"polynomial": )" +
        pair_of(slider, v) + R"(}}], "outputs": ["crank.angle"],
        "analyses": [{"type": "dynamics", "digits": false, "tolerance": 1e-5, "until": )" +
        text_of(2 * instant) + R"(, "every": )" + text_of(instant / 5) + R"(, "method": ")" + method + "\"" +
        (method == "rattle" ? R"(, "step": )" + text_of(instant / 300.5) : "") + "}]}");
    const AnalysisReport& report = run.analysis().report;
    if (report.status != Status::lock_up) return method + ": " + report.message;
    const double off = std::abs(run.last("t") - instant) / instant;
    return off < 1e-6 ? "" : method + " is off by " + text_of(off);
  });
}

}  // namespace
}  // namespace catena::testing
