// Mechanisms whose drivers ask for a place that lies at infinity: the same status in every analysis that moves them.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/sanitized.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

const std::vector<std::string> moving{R"({"type": "kinematics", "until": 1, "every": 0.1})",
                                      R"({"type": "inverse_dynamics", "until": 1, "every": 0.1})",
                                      R"({"type": "dynamics", "until": 1, "every": 0.1})"};

/// A block on a line at height h, in the slot of a rod through the origin that a motor turns towards that line: at
/// h / tan(angle), which lies at infinity once the angle is zero.
std::string runaway(double h, double angle, double rate, const std::string& analysis) {
  const std::string y = text_of(h), x = text_of(h / std::tan(angle));
  return R"({"catena": 1, "bodies": {"rod": {"mass": 1, "inertia": 0.1, "angle": )" + text_of(angle) + "}," +
         R"("block": {"mass": 1, "inertia": 0.1, "position": [)" + x + ", " + y + R"(]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "rod"},
      {"type": "slot", "i": "rod", "j": "block", "axis_i": [1, 0], "value": 0},)" +
         R"({"type": "translational", "i": ["ground", [0, )" + y + R"(]], "j": "block", "axis_i": [1, 0]}],
    "drivers": [{"type": "absolute_angle", "name": "motor", "i": "rod", "value": {"polynomial": [)" +
         text_of(angle) + ", " + text_of(rate) + R"(]}}], "outputs": ["block.x"], "analyses": [)" + analysis + "]}";
}

TEST(PlacesAtInfinity, AreALockUpInEveryAnalysis) {
  for (unsigned seed = 1; seed <= size_of_test(3u, 1u); ++seed) {
    RandomNumbers random(seed);
    const double h = std::pow(10.0, random(-2, 2)), rate = random(1, 3), angle = rate * random(0.3, 0.5);
    for (const std::string& analysis : moving) {
      // From either side.
      const double side = seed % 2 ? 1 : -1;
      const TextRun run = run_text(runaway(h, side * angle, -side * rate, analysis));
      ASSERT_EQ(run.outcome.analyses.size(), 1u) << run.outcome.error_text;
      const AnalysisReport& report = run.analysis().report;
      EXPECT_EQ(report.status, Status::lock_up) << seed << " " << analysis << ": " << report.message;
      EXPECT_NE(report.message.find("body \"block\" would reach only at infinity"), std::string::npos)
          << report.message;
      const std::size_t at = report.message.find("t = ");
      ASSERT_NE(at, std::string::npos) << report.message;
      // Dynamics ends some way before, and extrapolates.
      const double allowed = analysis == moving.back() ? 1e-2 : 1e-6;
      EXPECT_NEAR(std::stod(report.message.substr(at + 4)), angle / rate, allowed * angle / rate) << analysis;
      // No row pretends to a place there.
      const std::vector<double> t = run.column("t"), x = run.column("block.x");
      for (std::size_t r = 0; r < t.size(); ++r)
        EXPECT_NEAR(x[r], h / std::tan(side * (angle - rate * t[r])), 1e-6 * std::abs(x[r])) << analysis;
    }
  }
}

}  // namespace
}  // namespace catena::testing
