// Random chains over drums and on floors, and slack nets, by the thousand: none wrong, at most three in a hundred
// refused.
#include <cstdio>

#include "oracles/supported_chains.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

template <class Judge>
void check_by_the_thousand(Judge&& judge) {
  const int cases = stress_cases(1000), first = static_cast<int>(first_case(101));
  int wrong = 0, refused = 0;
  for (int seed = first; seed < first + cases; ++seed) {
    const OneSidedVerdict verdict = judge(static_cast<unsigned>(seed));
    refused += !verdict.ok;
    wrong += !verdict.fault.empty();
    if (!verdict.ok || !verdict.fault.empty()) {
      std::printf("  seed %d: %s\n", seed, (verdict.ok ? verdict.fault : verdict.said).c_str());
    }
  }
  std::printf("%d cases, %d wrong, %d refused\n", cases, wrong, refused);
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(refused, 3 * cases / 100);
}

TEST(OneSidedByTheThousand, ChainsOverDrumsAndOnFloors) {
  check_by_the_thousand([](unsigned seed) { return judge_supported_chain(random_supported_chain(seed)); });
}

TEST(OneSidedByTheThousand, SlackNets) {
  check_by_the_thousand([](unsigned seed) { return judge_slack_net(random_slack_net(seed)); });
}

}  // namespace
}  // namespace catena::testing
