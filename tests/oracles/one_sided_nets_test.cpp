// Nets of cables of which some are slack: every knot balances, nothing pushes, the energy is the least there is.
#include <gtest/gtest.h>

#include <cmath>

#include "oracles/random_seeds.hpp"
#include "oracles/slack_nets.hpp"

namespace catena::testing {
namespace {

struct NetSize {
  int columns, rows;
  std::size_t least, most;  // members
};

class SlackNets : public ::testing::TestWithParam<NetSize> {};

TEST_P(SlackNets, BalancesWithPullsAlone) {
  const auto [columns, rows, least, most] = GetParam();
  for (const unsigned seed : {1u, 2u, 3u}) {
    const SlackNet net = make_slack_net({.columns = columns, .rows = rows}, seed);
    ASSERT_GE(net.cable.size(), least);
    ASSERT_LE(net.cable.size(), most);
    Equilibrium analysis(net.model);
    const EquilibriumReport report = analysis.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_EQ(report.solver, "newton");
    const std::vector<GapState> states = gap_states(analysis, *net.model);
    expect_complementary(states, net.total, 1);
    std::vector<double> tension;
    int slack = 0;
    for (const GapState& s : states) {
      tension.push_back(s.force);
      slack += s.force == 0;
    }
    EXPECT_GT(slack, 0);
    EXPECT_LE(imbalance(net, knots_of(analysis), tension), 1e-9 * net.total);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SlackNets,
                         ::testing::Values(NetSize{2, 4, 10, 14}, NetSize{5, 8, 80, 110}, NetSize{18, 20, 900, 1100}));

class ElasticNets : public ::testing::TestWithParam<NetSize> {};

TEST_P(ElasticNets, BalancesWithPullsAlone) {
  const auto [columns, rows, least, most] = GetParam();
  static_cast<void>(least);
  static_cast<void>(most);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const SlackNet net = make_slack_net({.columns = columns, .rows = rows, .elastic = true}, seed);
    Equilibrium analysis(net.model);
    const EquilibriumReport report = analysis.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    const std::vector<Vec2<double>> knots = knots_of(analysis);
    std::vector<double> tension;
    int slack = 0;
    const std::vector<double> stretch = stretches(net, knots);
    for (std::size_t c = 0; c < stretch.size(); ++c) {
      tension.push_back(net.stiffness[c] * std::max(stretch[c], 0.0));
      slack += tension.back() == 0;
    }
    EXPECT_GT(slack, 0);
    EXPECT_LE(imbalance(net, knots, tension), 1e-9 * net.total);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ElasticNets,
                         ::testing::Values(NetSize{2, 4, 0, 0}, NetSize{5, 8, 0, 0}, NetSize{18, 20, 0, 0}));

// A share of those in tests/stress/one_sided_test.cpp.
TEST(RandomSlackNets, BalanceWithPullsAlone) {
  expect_no_fault(1, 25, [](unsigned seed) {
    const OneSidedVerdict verdict = judge_slack_net(random_slack_net(seed));
    return verdict.ok ? verdict.fault : verdict.said;
  });
}

}  // namespace
}  // namespace catena::testing
