// Elastic chains on a floor against nested bisection: random ones, and long ones in few iterations.
#include "oracles/elastic_chains.hpp"

#include <gtest/gtest.h>

#include "analysis/sanitized.hpp"

namespace catena::testing {
namespace {

TEST(ElasticChains, RandomOnesAgreeWithBisection) {
  std::mt19937 random(7);
  int refused = 0;
  for (int k = 0; k < size_of_test(60, 15); ++k) {
    const ElasticChain chain = random_elastic_chain(random, 80);
    const ElasticChainVerdict verdict = judge_elastic_chain(chain);
    if (!verdict.taut) continue;
    refused += !verdict.ok;
    EXPECT_TRUE(!verdict.ok || verdict.right) << k << ": " << verdict.said;
  }
  EXPECT_EQ(refused, 0);
}

class MooringLine : public ::testing::TestWithParam<int> {};

TEST_P(MooringLine, LiesAndHangs) {
  // 850 m of chain, 3.27e9 N, from the seabed to a fairlead 779.6 m away and 186 m up.
  const int n = GetParam();
  ElasticChain line{.count = n, .length = 850.0 / n, .stiffness = 3.27e9 * n / 850, .reach = 779.6, .height = 186};
  line.weight = (685 - 1025 * std::acos(-1) / 4 * 0.333 * 0.333) * line.length * gravity_of_earth;
  const auto model = elastic_chain(line);
  Equilibrium analysis(model);
  const EquilibriumReport report = analysis.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
  EXPECT_LE(report.counters.iterations, 200);  // 36 ... 105 measured: they do not grow with the length
  const ElasticChainSolution exact = solve_elastic_chain(line);
  const SystemState state = analysis.state();
  for (std::size_t k = 0; k < exact.node.size(); ++k) {
    EXPECT_NEAR(state.q[3 * k], exact.node[k].x, 1e-6) << k;
    EXPECT_NEAR(state.q[3 * k + 1], exact.node[k].y, 1e-6) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, MooringLine, ::testing::Values(50, 300, 1000, 3000, 5000));

}  // namespace
}  // namespace catena::testing
