// A share of the random chains over drums and on sloping floors in tests/stress/one_sided_test.cpp.
#include "oracles/supported_chains.hpp"

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"

namespace catena::testing {
namespace {

// Drums that the search does not find a way round are refused: of these none.
TEST(SupportedChains, BalanceAndPushOutwards) {
  expect_no_fault(1, size_of_test(40u, 14u), [](unsigned seed) {
    const OneSidedVerdict verdict = judge_supported_chain(random_supported_chain(seed));
    return verdict.ok ? verdict.fault : verdict.said;
  });
}

}  // namespace
}  // namespace catena::testing
