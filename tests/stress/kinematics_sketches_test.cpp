// Thousands of linkages sketched in one line, and of slider-cranks in or on their way to a dead centre.
#include "oracles/sketches.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

TEST(KinematicStress, FlatAndStraightSketchesAssembleInEveryAnalysis) {
  for (unsigned seed = first_case(1000); seed <= last_case(4000, 1000); ++seed) expect_assembled(seed);
}

TEST(KinematicStress, DeadCentresLockOrLeaveBothWays) {
  for (const char* analysis : {"kinematics", "dynamics"}) {
    for (unsigned seed = first_case(1000); seed <= last_case(4000, 1000); ++seed) expect_dead_centre(seed, analysis);
  }
}

}  // namespace
}  // namespace catena::testing
