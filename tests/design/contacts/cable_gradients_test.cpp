// Gradients of motions with elastic cables: closed forms where these stay taut; none, and a reason, where they pass
// their kink.
#include <gtest/gtest.h>

#include <cmath>

#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

/// A weight below the end of a cable of length 0.7, its place and its way upwards, hung up so that it may only sway up
/// and down.
std::string hanging(double y, double v, const std::string& mode) {
  return R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"k": 800, "l": 0.7, "m": 1.3, "v": )" + text_of(v) +
         R"(}, "bodies": {"b": {"particle": true, "mass": "m", "position": [0, )" + text_of(y) +
         R"(], "velocity": [0, "v"]}}, "constraints": [{"type": "absolute_x", "i": "b", "value": 0}],
    "forces": [{"type": "cable", "name": "c", "i": ["ground", [0, 0]], "j": "b", "length": "l", "k": "k"}],
    "analyses": [{"type": "sensitivity", "mode": ")" +
         mode + R"(", "parameters": ["k", "l", "m", "v"], "of": {"type": "dynamics", "until": 0.5, "tolerance": 1e-11,
      "measures": {"y": {"final": "b.y"}}}}]})";
}

// y = -l - m g / k + a cos(w t) + v / w sin(w t) about where it would rest.
TEST(CableGradients, OfOneThatStaysTaut) {
  const double k = 800, l = 0.7, m = 1.3, v = 0.05, g = 9.81, t = 0.5, y0 = -0.715;
  const double w = std::sqrt(k / m), a = y0 + l + m * g / k, c = std::cos(w * t), s = std::sin(w * t);
  const double by_w = -a * t * s + v * (t * c / w - s / (w * w)), by_rest = 1 - c;
  for (const std::string mode : {"forward", "adjoint"}) {
    const TextRun run = run_text(hanging(y0, v, mode));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_NEAR(value(run, "y"), -l - m * g / k + a * c + v / w * s, 1e-10);
    EXPECT_NEAR(gradient(run, "y", 0), by_rest * m * g / (k * k) + by_w * w / (2 * k), 1e-10);
    EXPECT_NEAR(gradient(run, "y", 1), -by_rest, 1e-10);
    EXPECT_NEAR(gradient(run, "y", 2), -by_rest * g / k - by_w * w / (2 * m), 1e-10);
    EXPECT_NEAR(gradient(run, "y", 3), s / w, 1e-10);
  }
}

TEST(CableGradients, OfOneThatBecomesTautAreNotGiven) {
  for (const std::string mode : {"forward", "adjoint"}) {
    const TextRun run = run_text(hanging(-0.3, 0.4, mode));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    for (std::size_t p = 0; p < 4; ++p) EXPECT_TRUE(std::isnan(gradient(run, "y", p))) << p;
    EXPECT_TRUE(warns(run, "cable \"c\" has become taut")) << ::testing::PrintToString(run.analysis().report.warnings);
  }
}

// The same weight on a rope over a pulley, whose other end is held: 0.7 m hang below the pulley where it is taut.
TEST(CableGradients, OfARopeOverAPulleyThatBecomesTautAreNotGiven) {
  for (const double y : {-0.3, -0.72}) {
    const TextRun run = run_text(
        R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"k": 800, "l": 1.0}, "bodies": {
        "b": {"particle": true, "mass": 1.3, "position": [0.1, )" +
        text_of(y) +
        R"(], "velocity": [0, 0.05]}}, "constraints": [{"type": "absolute_x", "i": "b", "value": 0.1}],
        "forces": [{"type": "rope", "name": "r", "i": ["ground", [-0.1, -0.2]],
          "over": [{"at": ["ground", [0, 0]], "radius": 0.1, "side": -1}], "j": "b", "length": "=0.9 + 0.1*pi", "k": "k"}],
        "analyses": [{"type": "sensitivity", "parameters": ["k"], "of": {"type": "dynamics", "until": 0.5,
          "tolerance": 1e-11, "measures": {"y": {"final": "b.y"}}}}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    EXPECT_EQ(std::isnan(gradient(run, "y", 0)), y > -0.5) << ::testing::PrintToString(run.analysis().report.warnings);
    EXPECT_EQ(warns(run, "rope \"r\" has become taut"), y > -0.5);
  }
}

}  // namespace
}  // namespace catena::testing
