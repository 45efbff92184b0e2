// alpha keeps to ten tolerances in motions of many radians, whose closed forms are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// x = 1 + cos(10 t) / 2, 16 periods.
TEST(AlphaAccuracy, OfASpringOverManyPeriods) {
  for (const double tolerance : {1e-3, 1e-4}) {
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"p": {"particle": true, "mass": 1, "position": [1.5, 0]}},
        "forces": [{"type": "spring_damper", "i": "ground", "j": "p", "k": 100, "length": 1}], "outputs": ["p.x"],
        "analyses": [{"type": "dynamics", "until": 10, "every": 0.1, "digits": false, "method": "alpha", "tolerance": )" +
        text_of(tolerance) + "}]}");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    const std::vector<double> t = run.column("t"), x = run.column("p.x");
    double most = 0;
    for (std::size_t k = 0; k < t.size(); ++k) most = std::max(most, std::abs(x[k] - 1 - std::cos(10 * t[k]) / 2));
    EXPECT_LT(most, 10 * tolerance);
  }
}

// A Kepler ellipse of semi-axes 1 and 0.8: x = cos E - 0.6, y = 0.8 sin E, t = E - 0.6 sin E; rows at even E.
TEST(AlphaAccuracy, OfAKeplerEllipse) {
  std::string instants;
  for (int k = 1; k <= 16; ++k) {
    const double e = k * std::numbers::pi / 8;
    instants += (k > 1 ? ", " : "") + text_of(e - 0.6 * std::sin(e));
  }
  for (const double tolerance : {1e-3, 1e-4}) {
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"p": {"particle": true, "mass": 1, "position": [0.4, 0], "velocity": [0, 2]}},
        "forces": [{"type": "point_force", "i": "p",
                    "force": ["=-p.x/(p.x^2+p.y^2)^1.5", "=-p.y/(p.x^2+p.y^2)^1.5"]}], "outputs": ["p.x", "p.y"],
        "analyses": [{"type": "dynamics", "digits": false, "method": "alpha", "at": [)" +
        instants + R"(], "tolerance": )" + text_of(tolerance) + "}]}");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    const std::vector<double> x = run.column("p.x"), y = run.column("p.y");
    ASSERT_EQ(x.size(), 16U);
    double most = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double e = static_cast<double>(k + 1) * std::numbers::pi / 8;
      most = std::max({most, std::abs(x[k] - std::cos(e) + 0.6), std::abs(y[k] - 0.8 * std::sin(e))});
    }
    EXPECT_LT(most, 10 * tolerance);
  }
}

}  // namespace
}  // namespace catena::testing
