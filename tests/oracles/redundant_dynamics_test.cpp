// A few random mechanisms with redundant equations or massless bodies, of every kind, against their known motion; many
// more in tests/stress/redundant_dynamics_test.cpp.
#include "oracles/redundant_trials.hpp"

namespace catena {
namespace {

using namespace testing;

template <class Draw>
void check(Draw&& draw) {
  TrialCounts counts;
  run_known_trials(
      draw, 1, 1,
      {IntegrationMethod::automatic, IntegrationMethod::rk5, IntegrationMethod::adams, IntegrationMethod::baumgarte,
       IntegrationMethod::partitioning},
      {1e-4, 1e-8}, counts, [](unsigned seed, IntegrationMethod method, double tolerance, const TrialOutcome& outcome) {
        ADD_FAILURE() << "seed " << seed << ", " << to_string(method) << ", tolerance " << tolerance << ": "
                      << outcome.message << ", error " << outcome.ratio << " times what is allowed";
      });
}

class RedundantMotion : public ::testing::TestWithParam<int> {};
TEST_P(RedundantMotion, IsTheKnownOne) {
  check([](unsigned seed) { return draw_redundant(GetParam(), seed); });
}
INSTANTIATE_TEST_SUITE_P(Kinds, RedundantMotion, ::testing::Range(0, number_of_kinds));

class MasslessMotion : public ::testing::TestWithParam<int> {};
TEST_P(MasslessMotion, IsTheKnownOne) {
  check([](unsigned seed) { return draw_massless(GetParam(), seed); });
}
INSTANTIATE_TEST_SUITE_P(Kinds, MasslessMotion, ::testing::Range(0, all_massless_kinds));

}  // namespace
}  // namespace catena
