// The seeds of stress/random_invariance_test.cpp whose answer once depended on units: equilibria by a metric that mixed
// metres and radians, by Lanczos steps on compliances in m/N, and by a curvature in 1/m beside stiffnesses in N/m;
// motions by a length scale of 1 m and by rows in metres compared with rows in radians.
#include "oracles/random_seeds.hpp"
#include "stress/random_invariance.hpp"

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

}  // namespace
}  // namespace catena::testing
