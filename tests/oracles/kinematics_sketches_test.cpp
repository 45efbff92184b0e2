// A share of the random sketches and dead centres of tests/stress.
#include "oracles/sketches.hpp"

namespace catena::testing {
namespace {

TEST(KinematicSketches, FlatAndStraightOnesAssembleInEveryAnalysis) {
  for (unsigned seed = 0; seed < 60; ++seed) expect_assembled(seed);
  expect_assembled(505603);  // needs fourteen starts
}

TEST(KinematicSketches, DeadCentresLockOrLeaveBothWays) {
  for (const char* analysis : {"kinematics", "dynamics"}) {
    for (unsigned seed = 0; seed < 60; ++seed) expect_dead_centre(seed, analysis);
  }
}

}  // namespace
}  // namespace catena::testing
