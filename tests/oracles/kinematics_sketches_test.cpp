// A share of the random sketches and dead centres of tests/stress.
#include "analysis/sanitized.hpp"
#include "oracles/sketches.hpp"

namespace catena::testing {
namespace {

TEST(KinematicSketches, FlatAndStraightOnesAssembleInEveryAnalysis) {
  for (unsigned seed = 0; seed < size_of_test(60u, 15u); ++seed) expect_assembled(seed);
  expect_assembled(505603);  // needs fourteen starts
}

TEST(KinematicSketches, DeadCentresLockOrLeaveBothWays) {
  for (const char* analysis : {"kinematics", "dynamics"}) {
    for (unsigned seed = 0; seed < size_of_test(60u, 15u); ++seed) expect_dead_centre(seed, analysis);
  }
}

}  // namespace
}  // namespace catena::testing
