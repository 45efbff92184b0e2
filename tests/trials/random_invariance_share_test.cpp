// The seeds of stress/random_invariance_test.cpp whose answer once depended on units: equilibria by a metric that mixed
// metres and radians, by Lanczos steps on compliances in m/N, and by a curvature in 1/m beside stiffnesses in N/m;
// motions by a length scale of 1 m and by rows in metres compared with rows in radians. And those that were refused a
// million sizes from the origin: partitioning and equilibria took the rounding of curves on the ground, and of
// equations without freedom there, for equations that are not met.
#include "oracles/random_seeds.hpp"
#include "stress/random_analyses.hpp"

namespace catena::testing {
namespace {

class OtherUnits : public ::testing::TestWithParam<unsigned> {};

TEST_P(OtherUnits, DoNotMatter) {
  std::map<std::string, int> seen;
  EXPECT_EQ(fault_in_other_units(GetParam(), seen), "");
  EXPECT_EQ(seen["ok"], 1) << "without an answer nothing is compared";
}
INSTANTIATE_TEST_SUITE_P(Seeds, OtherUnits,
                         ::testing::Values(616u, 1916u, 2068u, 2416u, 2456u, 2976u, 1249u, 1495u, 1627u, 1771u, 2737u,
                                           1578u, 1612u, 2618u, 2642u));

class FarOrigin : public ::testing::TestWithParam<unsigned> {};

TEST_P(FarOrigin, DoesNotMatter) {
  std::map<std::string, int> seen;
  EXPECT_EQ(fault_far_away(GetParam(), seen), "");
  EXPECT_EQ(seen["ok"], 1) << "without an answer nothing is compared";
}
INSTANTIATE_TEST_SUITE_P(Seeds, FarOrigin, ::testing::Values(600025u, 600035u, 600044u));

TEST(OtherUnitsOfAnalyses, DoNotMatter) {
  std::map<std::string, int> seen;
  expect_no_fault(1, 30, [&](unsigned seed) { return fault_of_units(seed, seen); });
  // A dead point of a mechanism of nanometres, taken for a bifurcation.
  EXPECT_EQ(fault_of_units(600033, seen), "");
}

}  // namespace
}  // namespace catena::testing
