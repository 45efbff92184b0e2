// Modes of the trial scenes, and motions that nothing resists as equilibrium, modes and check name them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trials/trial.hpp"

namespace catena {
namespace {

using testing::run_text;
using testing::run_trial;
using testing::TextRun;

void expect_omega2(const TextRun& run, std::size_t analysis, const std::vector<double>& wanted, double relative) {
  const std::vector<double> found = run.column("omega2", analysis);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_NEAR(found[k], wanted[k], relative * wanted[k]) << k;
}

const FieldValue& field(const AnalysisResult& result, const std::string& name) {
  for (const NamedField& field : result.fields) {
    if (field.name == name) return field.value;
  }
  throw std::out_of_range(name);
}

TEST(ModesTrials, OfARing) {
  expect_omega2(run_trial("modes_of_a_ring"), 0, {0, 0, 0, 0, 0, 0.1, 0.1, 0.1, 0.1, 0.3, 0.3, 0.6}, 1e-13);
}

TEST(ModesTrials, OfARow) {
  const TextRun run = run_trial("modes_of_a_row");
  // Four that are free across the row; the lowest along it is that of [1.1 -1; -1 2 -1; ...; -1 1].
  const std::vector<double> omega2 = run.column("omega2");
  ASSERT_EQ(omega2.size(), 5u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(omega2[k], 0);
  EXPECT_NEAR(omega2[4], 0.0177791624150937, 1e-15);
  EXPECT_EQ(std::get<std::int64_t>(field(run.analysis(), "unstable")), 0);
  EXPECT_EQ(std::get<std::int64_t>(field(run.analysis(), "free_motions")), 4);
}

TEST(ModesTrials, OfManyEqualOnes) {
  expect_omega2(run_trial("modes_many_equal"), 0, {0, 0, 0, 0.6, 0.6, 0.6, 3.6, 3.6, 6.6}, 1e-13);
}

TEST(ModesTrials, DoNotDependOnUnits) {
  const TextRun small = run_trial("modes_at_a_nanometre");
  ASSERT_EQ(small.outcome.exit_code, 0);
  EXPECT_NEAR(small.first("omega2", 1), 3.42943, 1e-5);
  EXPECT_NEAR(small.last("omega2", 1), 95.6810, 1e-4);
}

TEST(ModesTrials, OfAFreeTrolley) {
  const TextRun run = run_trial("free_trolley");
  ASSERT_EQ(run.outcome.exit_code, 0);
  EXPECT_FALSE(std::get<bool>(field(run.analysis(0), "stable")));
  EXPECT_EQ(std::get<std::int64_t>(field(run.analysis(0), "negative_modes")), 0);
  // (M + m) m g l / ((M + m) (J + m l^2) - m^2 l^2)
  expect_omega2(run, 1, {0, 1.5 * 0.5 * 9.81 / (1.5 * 0.6 - 0.25)}, 1e-12);
}

TEST(ModesTrials, NameTheSameFreeMotionsInEveryAnalysis) {
  // The trolley beside a pendulum that is held, and a wheel that nothing turns.
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"held": {"mass": 1, "inertia": 1, "position": [5, -1]},
               "crab": {"mass": 1, "inertia": 0.1}, "load": {"mass": 0.5, "inertia": 0.1, "centroid": [0, -1]},
               "wheel": {"mass": 2, "inertia": 1, "position": [-5, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "held", "at": [5, 0]},
                    {"type": "translational", "i": "ground", "j": "crab", "axis_i": [1, 0], "axis_j": [1, 0]},
                    {"type": "revolute", "i": "crab", "j": "load"},
                    {"type": "revolute", "i": "ground", "j": "wheel", "at": [-5, 0]}],
    "analyses": [{"type": "check"}, {"type": "equilibrium"}, {"type": "modes"}], "outputs": ["crab.x"]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<std::string> wanted{"crab", "load", "wheel"};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(std::get<std::vector<std::string>>(field(run.analysis(k), "moving_freely")), wanted) << k;
    EXPECT_EQ(std::get<std::int64_t>(field(run.analysis(k), "free_motions")), 2) << k;
  }
  EXPECT_FALSE(std::get<bool>(field(run.analysis(1), "stable")));
}

TEST(ModesTrials, CheckCallsNothingFreeThatALoadDrives) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81],
    "bodies": {"stone": {"mass": 1, "inertia": 1}, "bar": {"mass": 1, "inertia": 1, "position": [1, 0]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "bar", "at": [0, 0]}],
    "analyses": [{"type": "check"}]})");
  // The stone is free to move along x and to turn, not to fall; the bar is driven by its weight.
  EXPECT_EQ(std::get<std::int64_t>(field(run.analysis(), "free_motions")), 2);
  EXPECT_EQ(std::get<std::vector<std::string>>(field(run.analysis(), "moving_freely")),
            std::vector<std::string>{"stone"});
}

// A body that hangs from one equation, at a distance h below the point held; all of it turned by an angle. The force
// passes the centroid, and rounding alone is left of its lever. It swings as m g h / J, and slides along freely.
TEST(ModesTrials, OfBodiesThatHangFromOneEquation) {
  std::mt19937 engine(7);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); };
  for (int k = 0; k < 200; ++k) {
    const double turned = draw(-3, 3), size = std::pow(10.0, draw(-3, 3)), mass = draw(0.1, 10);
    const double x = size * draw(-1, 1), y = size * draw(-1, 1), h = std::hypot(x, y);
    const double inertia = mass * h * h * draw(0.1, 3), start = draw(-3, 3), away = size * draw(-3, 3);
    const double c = std::cos(turned), s = std::sin(turned);
    const std::string slot = fmt::format(
        R"({{"type": "displacement", "i": ["ground", [{:.17g}, {:.17g}]], "j": ["b", [{:.17g}, {:.17g}]], "value": 0,
 "axis_i": [{:.17g}, {:.17g}]}})",
        size * c, size * s, x, y, s, -c);
    const TextRun run = run_text(fmt::format(
        R"({{"catena": 1, "gravity": [{:.17g}, {:.17g}], "bodies": {{"b": {{"mass": {:.17g}, "inertia": {:.17g},
 "position": [{:.17g}, {:.17g}], "angle": {:.17g}}}}}, "constraints": [{}],
 "analyses": [{{"type": "equilibrium"}}, {{"type": "modes"}}]}})",
        9.81 * s, -9.81 * c, mass, inertia, away, size, start, slot));
    ASSERT_EQ(run.outcome.exit_code, 0) << k << run.outcome.error_text;
    EXPECT_EQ(std::get<std::int64_t>(field(run.analysis(0), "free_motions")), 1) << k;
    expect_omega2(run, 1, {0, mass * 9.81 * h / inertia}, 1e-9);
  }
}

}  // namespace
}  // namespace catena
