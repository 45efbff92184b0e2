// Equilibria of the trial scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "trials/trial.hpp"

namespace catena {
namespace {

using testing::field;
using testing::run_trial;
using testing::TextRun;

TEST(StaticsTrials, StiffSpring) {
  // The same place as with a spring of 3e11 N/m, and forces that balance to what rounding leaves.
  const TextRun run = run_trial("stiff_spring_unbalanced");
  ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
  EXPECT_NEAR(field<double>(run, "energy"), -21.153, 5e-4);
  EXPECT_LE(field<double>(run, "residual"), 1e-2);
}

TEST(StaticsTrials, BalancedArm) {
  const TextRun run = run_trial("balanced_arm");
  ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
  EXPECT_TRUE(field<bool>(run, "neutral"));
  EXPECT_FALSE(field<bool>(run, "stable"));
  EXPECT_NEAR(run.last("arm.angle"), 70 * std::numbers::pi / 180, 1e-9);
}

TEST(StaticsTrials, BalancedParallelogram) {
  const TextRun run = run_trial("balanced_parallelogram");
  ASSERT_EQ(run.analysis(1).report.status, Status::ok) << run.analysis(1).report.message;
  EXPECT_NEAR(run.last("lower.angle", 1), 70 * std::numbers::pi / 180, 1e-9);
}

TEST(StaticsTrials, ElasticChainOnAFloor) {
  const TextRun run = run_trial("elastic_chain_on_floor");
  ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
  EXPECT_NEAR(run.last("first.force"), 1350.01e3, 20);
  // The fairlead's tension is that of the segment below it: half a mass less than at the pin itself.
  EXPECT_NEAR(run.last("last.force"), 2431.2e3, 100);
  EXPECT_LE(run.analysis().report.seconds, 5);
}

TEST(StaticsTrials, FarAway) {
  const TextRun run = run_trial("equilibrium_far_away");
  ASSERT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
  EXPECT_TRUE(field<bool>(run, "stable"));
}

TEST(StaticsTrials, AbsurdStiffness) {
  const TextRun run = run_trial("absurd_stiffness");
  EXPECT_EQ(run.analysis().report.status, Status::refused);
  EXPECT_NE(run.analysis().report.message.find("\"block\""), std::string::npos) << run.analysis().report.message;
}

}  // namespace
}  // namespace catena
