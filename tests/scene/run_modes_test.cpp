// modes in scenes: rows, fields, shapes as columns.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "catena/base/si_unit.hpp"
#include "scene/run_text.hpp"

namespace catena {
namespace {

using testing::run_text;
using testing::TextRun;

// A bar of 2 kg on a pin at one end, its author's origin 0.5 m off the centroid, and a mass on a spring.
std::string scene(const std::string& analyses) {
  return R"({"catena": 1, "gravity": [0, -10],
    "bodies": {"bar": {"mass": 2, "inertia": 1, "centroid": [0, -0.5], "points": {"tip": [0, -2]}},
               "block": {"mass": 4, "position": [3, 0], "particle": true}},
    "constraints": [{"name": "A", "type": "revolute", "i": "ground", "j": "bar"},
                    {"type": "absolute_y", "i": "block", "value": 0}],
    "forces": [{"name": "S", "type": "spring_damper", "i": ["ground", [2, 0]], "j": "block", "k": 100, "length": 1}],
    "analyses": [)" +
         analyses + "]}";
}

const std::vector<double>& list(const AnalysisResult& result, const std::string& name) {
  for (const NamedField& field : result.fields) {
    if (field.name == name) return std::get<std::vector<double>>(field.value);
  }
  throw std::out_of_range(name);
}

TEST(RunModes, GivesRowsAndLists) {
  const TextRun run = run_text(scene(R"({"type": "modes"})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const AnalysisResult& result = run.analysis();
  EXPECT_EQ(result.rows, 2);
  // m g d / (J + m d^2) and k / m.
  const double slow = 2 * 10 * 0.5 / (1 + 2 * 0.25);
  ASSERT_EQ(list(result, "omega2").size(), 2u);
  EXPECT_NEAR(list(result, "omega2")[0], slow, 1e-12);
  EXPECT_NEAR(list(result, "omega")[1], 5, 1e-12);
  EXPECT_EQ(run.column("mode"), (std::vector<double>{1, 2}));
  EXPECT_EQ(run.column("omega2"), list(result, "omega2"));
  EXPECT_EQ(run.column("omega"), list(result, "omega"));
  ASSERT_EQ(result.columns.size(), 3u);
  EXPECT_EQ(si_unit(result.columns[1].unit), "rad^2/s^2");
  EXPECT_EQ(si_unit(result.columns[2].unit), "rad/s");
}

TEST(RunModes, GivesShapesOfTheColumnsAskedFor) {
  const TextRun run = run_text(scene(
      R"({"type": "modes", "shapes": true, "outputs": ["bar.tip", "bar", "A.angle", "S.length", "S.force", "energy"]})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  // Modal mass 1: (J + m d^2) phi^2 = 1, the tip 2 m below the pin moves along x.
  const double turn = 1 / std::sqrt(1.5);
  EXPECT_NEAR(run.first("bar.angle"), turn, 1e-12);
  EXPECT_NEAR(run.first("A.angle"), turn, 1e-12);
  EXPECT_NEAR(run.first("bar.tip.x"), 2 * turn, 1e-12);
  EXPECT_NEAR(run.first("bar.tip.y"), 0, 1e-12);
  EXPECT_NEAR(run.first("bar.x"), 0, 1e-12);
  EXPECT_NEAR(run.last("bar.angle"), 0, 1e-12);
  EXPECT_NEAR(run.last("S.length"), 0.5, 1e-12);
  EXPECT_TRUE(run.column("S.force").empty());
  // What is no place is left out, and that is said.
  ASSERT_FALSE(run.analysis().report.warnings.empty());
  EXPECT_NE(run.analysis().report.warnings.back().find("left out"), std::string::npos);
}

TEST(RunModes, ShowsAllBodiesByDefault) {
  const TextRun run = run_text(scene(R"({"type": "modes", "shapes": true, "count": 1})"));
  EXPECT_EQ(run.analysis().columns.size(), 3u + 6u);
  EXPECT_EQ(run.analysis().rows, 1);
  EXPECT_NEAR(run.first("bar.angle"), 1 / std::sqrt(1.5), 1e-12);
}

TEST(RunModes, GoOnFromTheEquilibriumBefore) {
  // Let go at 40 degrees, the pendulum settles; its modes are those of the hanging one.
  const TextRun run = run_text(scene(R"({"type": "equilibrium"}, {"type": "modes", "count": 2},
                                        {"type": "modes", "set": {}, "count": 1})"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(list(run.analysis(1), "omega2")[0], 10 / 1.5, 1e-11);
  EXPECT_NEAR(list(run.analysis(2), "omega2")[0], 10 / 1.5, 1e-11);
}

// An arm that rests on the lower or the upper of a stop's two bounds swings on the stop's stiffness k, as on a spring:
// (k + V'') / J about the pin, V'' = -m g d sin(angle).
TEST(RunModes, OfAnArmBetweenTwoCompliantBounds) {
  for (int n = 0; n < 12; ++n) {
    const bool lower = n % 2 == 0;
    const double least = -1.2 + 0.17 * n, most = least + 0.2 + 0.05 * n, k = 300 * (n + 1), start = (least + most) / 2;
    const double g = lower ? 9.81 : -9.81, end = lower ? least : most;
    const auto number = [](double x) { return std::to_string(x); };
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, )" + number(-g) + R"(], "bodies": {"arm": {"mass": 2,
        "inertia": 0.1, "centroid": [0.5, 0], "angle": )" +
                                 number(start) + R"(}},
      "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "arm"}],
      "forces": [{"type": "stop", "name": "stop", "column": "pin.angle", "min": )" +
                                 number(least) + R"(, "max": )" + number(most) + R"(, "k": )" + number(k) + R"(}],
      "outputs": ["arm.angle"], "analyses": [{"type": "equilibrium"}, {"type": "modes"}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const double angle = run.last("arm.angle");
    ASSERT_NEAR(angle, end, 2e-6) << n;
    const double wanted = (k - 2 * g * 0.5 * std::sin(angle)) / (0.1 + 2 * 0.25);
    EXPECT_NEAR(list(run.analysis(1), "omega2")[0], wanted, 1e-9 * wanted) << n;
  }
}

}  // namespace
}  // namespace catena
