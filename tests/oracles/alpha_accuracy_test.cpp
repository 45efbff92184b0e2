// Motions of many radians may be off by more than ten tolerances, of alpha, which judges each step by itself, and of
// order 5: a warning tells by how many, and none is given where they are not. Closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

const std::string said = "the motion is off by some ";

/// How many tolerances a run says to be off; 0: no word of it.
double told(const TextRun& run) {
  for (const std::string& warning : run.analysis().report.warnings) {
    if (warning.starts_with(said)) return std::stod(warning.substr(said.size()));
  }
  return 0;
}

/// x = 1 + cos(10 t) / 2; the length scale is half of 1.5 m.
TextRun spring(double until, const std::string& more) {
  return run_text(
      R"({"catena": 1, "bodies": {"p": {"particle": true, "mass": 1, "position": [1.5, 0]}},
      "forces": [{"type": "spring_damper", "i": "ground", "j": "p", "k": 100, "length": 1}], "outputs": ["p.x"],
      "analyses": [{"type": "dynamics", "every": 0.1, "method": "alpha", "until": )" +
      text_of(until) + ", " + more + "}]}");
}

double error_of_spring(const TextRun& run) {
  const std::vector<double> t = run.column("t"), x = run.column("p.x");
  double most = 0;
  for (std::size_t k = 0; k < t.size(); ++k) most = std::max(most, std::abs(x[k] - 1 - std::cos(10 * t[k]) / 2));
  return most / 0.75;
}

TEST(AlphaAccuracy, OfASpringOverManyPeriodsIsTold) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(tolerance);
    const TextRun run = spring(10, R"("tolerance": )" + text_of(tolerance));
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    EXPECT_GT(error_of_spring(run), 10 * tolerance);
    EXPECT_NEAR(told(run), error_of_spring(run) / tolerance, 2);
    const TextRun finer = spring(10, R"("tolerance": )" + text_of(tolerance / 4));
    EXPECT_LT(error_of_spring(finer), 10 * tolerance);
    const TextRun brief = spring(2, R"("tolerance": )" + text_of(tolerance));
    EXPECT_LT(error_of_spring(brief), 10 * tolerance);
    EXPECT_TRUE(brief.analysis().report.warnings.empty()) << brief.analysis().report.warnings.front();
  }
}

TEST(AlphaAccuracy, IsSaidNotToBeKnownWithoutASecondRun) {
  const TextRun run = spring(10, R"("tolerance": 1e-3, "digits": false)");
  ASSERT_EQ(run.analysis().report.warnings.size(), 1U);
  EXPECT_NE(run.analysis().report.warnings[0].find("is not known"), std::string::npos);
  EXPECT_TRUE(spring(10, R"("step": 1e-3, "digits": false)").analysis().report.warnings.empty());
}

// A Kepler ellipse of semi-axes 1 and 0.8: x = cos E - 0.6, y = 0.8 sin E, t = E - 0.6 sin E; rows at even E.
TextRun ellipse(const std::string& method, const std::string& tolerance, int turns) {
  std::string instants;
  for (int k = 1; k <= 16 * turns; ++k) {
    const double e = k * std::numbers::pi / 8;
    instants += (k > 1 ? ", " : "") + text_of(e - 0.6 * std::sin(e));
  }
  return run_text(
      R"({"catena": 1, "bodies": {"p": {"particle": true, "mass": 1, "position": [0.4, 0], "velocity": [0, 2]}},
        "forces": [{"type": "point_force", "i": "p",
                    "force": ["=-p.x/(p.x^2+p.y^2)^1.5", "=-p.y/(p.x^2+p.y^2)^1.5"]}], "outputs": ["p.x", "p.y"],
        "analyses": [{"type": "dynamics", "method": ")" +
      method + R"(", "at": [)" + instants + R"(], "tolerance": )" + tolerance + "}]}");
}

double error_of_ellipse(const TextRun& run) {
  const std::vector<double> x = run.column("p.x"), y = run.column("p.y");
  double most = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double e = static_cast<double>(k + 1) * std::numbers::pi / 8;
    most = std::max({most, std::abs(x[k] - std::cos(e) + 0.6), std::abs(y[k] - 0.8 * std::sin(e))});
  }
  return most;
}

TEST(AlphaAccuracy, OfAKeplerEllipseIsTold) {
  const TextRun run = ellipse("alpha", "1e-5", 1);
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_GT(error_of_ellipse(run), 200e-5);
  EXPECT_GT(told(run), 200);
  EXPECT_TRUE(ellipse("radau", "1e-5", 1).analysis().report.warnings.empty());
}

// Of rk5 the digits follow from the error that is carried along, and the word from a second run.
TEST(AlphaAccuracy, OfThreeTurnsByOrder5IsTold) {
  for (const std::string tolerance : {"1e-5", "1e-7"}) {
    SCOPED_TRACE(tolerance);
    const TextRun run = ellipse("rk5", tolerance, 3);
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    const double off = error_of_ellipse(run) / std::stod(tolerance);
    EXPECT_GT(off, 20);
    EXPECT_NEAR(told(run), off, off / 2);
    for (const std::string other : {"rk8", "adams"})
      EXPECT_TRUE(ellipse(other, tolerance, 3).analysis().report.warnings.empty()) << other;
  }
}

}  // namespace
}  // namespace catena::testing
