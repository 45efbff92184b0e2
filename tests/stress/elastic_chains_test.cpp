// Elastic chains on a floor by the thousand against nested bisection, and the longest ones.
#include "oracles/elastic_chains.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "stress/cases.hpp"

namespace catena::testing {
namespace {

TEST(ElasticChains, ByTheThousand) {
  const int cases = stress_cases(3000);
  std::mt19937 random(first_case());
  int taut = 0, folded = 0, wrong = 0, refused = 0;
  for (int k = 0; k < cases; ++k) {
    const ElasticChain chain = random_elastic_chain(random, 300);
    const ElasticChainVerdict verdict = judge_elastic_chain(chain);
    if (!verdict.taut) continue;
    ++taut;
    folded += verdict.folded;
    refused += !verdict.ok;
    wrong += verdict.ok && !verdict.right;
    if (!verdict.ok || !verdict.right) {
      std::printf("%d: n %d, length %.3g, k %.3g, w %.3g, reach %.4g, height %.4g, bend %.3g: %s\n", k, chain.count,
                  chain.length, chain.stiffness, chain.weight, chain.reach, chain.height, chain.bend,
                  verdict.said.c_str());
    }
  }
  std::printf("%d cases, %d in another place, %d wrong, %d refused\n", taut, folded, wrong, refused);
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(refused, cases / 100);
}

}  // namespace
}  // namespace catena::testing
