// Rows inside one very short step: velocities are those of the motion, not rounding of positions over the step.
//
//   omega(t) = omega0 + alpha0 t + alpha'0 t^2 / 2 + O(t^3),   alpha = -k sin phi, k = m g l / (J + m l^2)
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

TEST(ShortSteps, VelocitiesBetweenTheirEndsAreExact) {
  const double phi = 1, omega = 0.5, m = 2, l = 0.7, inertia = 0.1, g = 9.81;
  const double k = m * g * l / (inertia + m * l * l), alpha = -k * std::sin(phi), jerk = -k * std::cos(phi) * omega;
  for (const std::string method : {"rk5", "radau", "rk8", "adams"}) {
    for (const double until : {1e-9, 1e-6, 1e-4}) {
      SCOPED_TRACE(method + " until " + text_of(until));
      // The pendulum hangs along -y where its angle is zero.
      const TextRun run =
          run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"mass": 2, "inertia": 0.1,
        "position": [)" +
                   text_of(l * std::sin(phi)) + ", " + text_of(-l * std::cos(phi)) + R"(], "angle": 1,
        "angular_velocity": 0.5}}, "constraints": [{"type": "revolute", "i": "ground", "j": ["b", [0, 0.7]]}],
        "outputs": ["b.omega"], "analyses": [{"type": "dynamics", "until": )" +
                   text_of(until) + R"(, "every": )" + text_of(until / 10) + R"(, "method": ")" + method + R"("}]})");
      ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
      const auto t = run.column("t"), rates = run.column("b.omega");
      for (std::size_t row = 0; row < t.size(); ++row)
        EXPECT_NEAR(rates[row], omega + t[row] * (alpha + t[row] * jerk / 2), 3e-15 + 100 * std::pow(t[row], 3)) << row;
    }
  }
}

}  // namespace
}  // namespace catena::testing
