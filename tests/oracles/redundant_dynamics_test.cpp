// A few random mechanisms with redundant equations, of every kind, against their known motion; many more in
// tests/stress/redundant_dynamics_test.cpp.
#include "oracles/redundant_trials.hpp"

namespace catena {
namespace {

using namespace testing;

class RedundantMotion : public ::testing::TestWithParam<int> {};

TEST_P(RedundantMotion, IsTheKnownOne) {
  std::map<IntegrationMethod, TrialCount> counts;
  run_redundant_trials(GetParam(), 1, 1,
                       {IntegrationMethod::automatic, IntegrationMethod::rk5, IntegrationMethod::adams,
                        IntegrationMethod::baumgarte, IntegrationMethod::partitioning},
                       {1e-4, 1e-8, 1e-11}, counts,
                       [](unsigned seed, IntegrationMethod method, double tolerance, const TrialOutcome& outcome) {
                         ADD_FAILURE() << "seed " << seed << ", " << to_string(method) << ", tolerance " << tolerance
                                       << ": " << outcome.message << ", error " << outcome.ratio
                                       << " times what is allowed";
                       });
}

INSTANTIATE_TEST_SUITE_P(Kinds, RedundantMotion, ::testing::Range(0, number_of_kinds));

}  // namespace
}  // namespace catena
