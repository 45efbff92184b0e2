// Nets of cables of which some are slack: every knot balances, nothing pushes, the energy is the least there is.
#include <gtest/gtest.h>

#include <cmath>

#include "oracles/one_sided_scenes.hpp"

namespace catena::testing {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

struct Net {
  std::shared_ptr<Model> model = std::make_shared<Model>();
  std::vector<double> weight;             // of the knots
  std::vector<std::array<int, 2>> cable;  // knots, -1: hung from the ground at `place`
  std::vector<Vec2<double>> place;
  std::vector<double> length, stiffness;  // stiffness 0: inextensible
};

// Rows of knots under a row of hooks, cables to the neighbours below, beside and across, all up to `slack` times longer
// than their distance.
Net make_net(int columns, int rows, unsigned seed, double slack, bool elastic) {
  Net net;
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  net.model->gravity = {0, -gravity_of_earth};
  std::vector<Vec2<double>> knots;
  for (int k = 0; k < columns * rows; ++k) {
    const double x = k % columns + uniform(-0.2, 0.2), y = -(k / columns) + uniform(-0.2, 0.2);
    knots.push_back({x, y});
    if (k < columns) continue;
    const double mass = uniform(0.5, 2);
    BodyValues body{.mass = mass, .position = {x, y}};
    body.particle = true;
    net.model->add_body("knot" + std::to_string(k), body);
    net.weight.push_back(mass * gravity_of_earth);
  }
  const auto tie = [&](int a, int b) {
    if (b < columns) return;
    const double length = norm(knots[at(b)] - knots[at(a)]) * uniform(1, slack);
    const double k = elastic ? uniform(500, 5000) : 0;
    const Vec2<double> hook = a < columns ? knots[at(a)] : Vec2<double>{};
    const int i = a < columns ? ground : a - columns, j = b - columns;
    if (elastic) {
      net.model->add_force("", ElasticCable<double>{hook, {}, length, k}, i, j);
    } else {
      net.model->add("", Cable<double>{hook, {}, length}, i, j);
    }
    net.cable.push_back({i, j});
    net.place.push_back(hook);
    net.length.push_back(length);
    net.stiffness.push_back(k);
  };
  for (int k = 0; k < columns * rows; ++k) {
    const bool inner = k % columns + 1 < columns, below = k + columns < columns * rows;
    if (below) tie(k, k + columns);
    if (inner) tie(k, k + 1);
    if (inner && below) tie(k, k + columns + 1);
  }
  return net;
}

// Forces on the knots at their places, from tensions; the largest that is left over.
double imbalance(const Net& net, const std::vector<Vec2<double>>& knot, const std::vector<double>& tension) {
  std::vector<Vec2<double>> sum;
  for (double w : net.weight) sum.push_back({0, -w});
  for (std::size_t c = 0; c < tension.size(); ++c) {
    const auto [i, j] = net.cable[c];
    const Vec2<double> h = knot[at(j)] - (i < 0 ? net.place[c] : knot[at(i)]), pull = (tension[c] / norm(h)) * h;
    sum[at(j)] += -pull;
    if (i >= 0) sum[at(i)] += pull;
  }
  double largest = 0;
  for (const Vec2<double>& s : sum) largest = std::max(largest, norm(s));
  return largest;
}

std::vector<Vec2<double>> knots_of(const Equilibrium& analysis) {
  const SystemState state = analysis.state();
  std::vector<Vec2<double>> knots;
  for (std::size_t k = 0; k + 2 < state.q.size(); k += 3) knots.push_back({state.q[k], state.q[k + 1]});
  return knots;
}

struct NetSize {
  int columns, rows;
  std::size_t least, most;  // members
};

class SlackNet : public ::testing::TestWithParam<NetSize> {};

TEST_P(SlackNet, BalancesWithPullsAlone) {
  const auto [columns, rows, least, most] = GetParam();
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Net net = make_net(columns, rows, seed, 1.3, false);
    ASSERT_GE(net.cable.size(), least);
    ASSERT_LE(net.cable.size(), most);
    Equilibrium analysis(net.model);
    const EquilibriumReport report = analysis.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_EQ(report.solver, "newton");
    const std::vector<GapState> states = gap_states(analysis, *net.model);
    double weight = 0;
    for (double w : net.weight) weight += w;
    expect_complementary(states, weight, 1);
    std::vector<double> tension;
    int slack = 0;
    for (const GapState& s : states) {
      tension.push_back(s.force);
      slack += s.force == 0;
    }
    EXPECT_GT(slack, 0);
    EXPECT_LE(imbalance(net, knots_of(analysis), tension), 1e-9 * weight);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SlackNet,
                         ::testing::Values(NetSize{2, 4, 10, 14}, NetSize{5, 8, 80, 110}, NetSize{18, 20, 900, 1100}));

class ElasticNet : public ::testing::TestWithParam<NetSize> {};

TEST_P(ElasticNet, BalancesWithPullsAlone) {
  const auto [columns, rows, least, most] = GetParam();
  static_cast<void>(least);
  static_cast<void>(most);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Net net = make_net(columns, rows, seed, 1.3, true);
    Equilibrium analysis(net.model);
    const EquilibriumReport report = analysis.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    const std::vector<Vec2<double>> knots = knots_of(analysis);
    std::vector<double> tension;
    int slack = 0;
    for (std::size_t c = 0; c < net.cable.size(); ++c) {
      const auto [i, j] = net.cable[c];
      const double apart = norm(knots[at(j)] - (i < 0 ? net.place[c] : knots[at(i)]));
      tension.push_back(net.stiffness[c] * std::max(apart - net.length[c], 0.0));
      slack += tension.back() == 0;
    }
    double weight = 0;
    for (double w : net.weight) weight += w;
    EXPECT_GT(slack, 0);
    EXPECT_LE(imbalance(net, knots, tension), 1e-9 * weight);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ElasticNet,
                         ::testing::Values(NetSize{2, 4, 0, 0}, NetSize{5, 8, 0, 0}, NetSize{18, 20, 0, 0}));

}  // namespace
}  // namespace catena::testing
