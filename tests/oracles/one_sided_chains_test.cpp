// Chains on a floor and over a drum: complementarity, balance, and the lifted parts against the discrete catenary.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/base/at.hpp"
#include "oracles/one_sided_scenes.hpp"

namespace catena::testing {
namespace {

// Reactions of the ends on the chain: forces that "left" and "right" exert on their link.
struct Ends {
  Vec2<double> left, right;
};

Ends ends_of(Equilibrium& analysis, const Model& model) {
  Ends ends;
  const auto force = [&](const char* name) {
    const auto row = at(analysis.plan().element_row[at(model.find_element(name))]);
    // h = r_Pj - r_Pi: the multipliers are what the joint takes off the link.
    return Vec2<double>{-analysis.lambda()[row], -analysis.lambda()[row + 1]};
  };
  ends.left = force("left");
  ends.right = force("right");
  return ends;
}

std::vector<double> angles_of(Equilibrium& analysis, int count) {
  const SystemState state = analysis.state();
  std::vector<double> angles;
  // Whole turns are the same place of a rod.
  for (int k = 0; k < count; ++k) angles.push_back(std::remainder(state.q[at(3 * k + 2)], 2 * std::numbers::pi));
  return angles;
}

// Half of a chain whose middle lies on the floor: n rods of length l and weight w rise by `height`; the rest of the
// half lies flat. Pull H along the chain and upward force V at the last joint on the floor from
//   tan(theta_k) = (V + (k - 1/2) w) / H,   sum l sin(theta_k) = height,   sum l cos(theta_k) + flat = half
struct Lifted {
  double pull = 0, lift = 0;
};

Lifted solve_lifted(int rods, double l, double w, double height, double flat, double half, Lifted guess) {
  for (int iteration = 0; iteration < 50; ++iteration) {
    double f = -height, g = flat - half, fh = 0, fv = 0, gh = 0, gv = 0;
    for (int k = 1; k <= rods; ++k) {
      const double tangent = (guess.lift + (k - 0.5) * w) / guess.pull, c = 1 / std::hypot(1, tangent), s = tangent * c;
      f += l * s;
      g += l * c;
      const double by_h = -tangent / guess.pull * c * c, by_v = c * c / guess.pull;
      fh += l * c * by_h;
      fv += l * c * by_v;
      gh -= l * s * by_h;
      gv -= l * s * by_v;
    }
    const double determinant = fh * gv - fv * gh;
    guess.pull -= (f * gv - fv * g) / determinant;
    guess.lift -= (fh * g - f * gh) / determinant;
  }
  return guess;
}

class ChainOnAFloor : public ::testing::TestWithParam<int> {};

TEST_P(ChainOnAFloor, LiesLevelAndHangsAsACatenary) {
  const int count = GetParam();
  constexpr double length = 4, half = 1.5, height = 0.8, mass = 0.1, w = mass * gravity_of_earth;
  const double l = length / count;
  for (const double bend : {0.5, -0.7}) {
    SCOPED_TRACE(bend);
    const auto model = chain_with_contacts(count, length, half, height, bend, floor_contact(), mass);
    Equilibrium analysis(model);
    const EquilibriumReport report = analysis.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_EQ(report.solver, "newton");
    EXPECT_TRUE(report.stable);
    const std::vector<GapState> states = gap_states(analysis, *model);
    const double weight = count * w;
    expect_complementary(states, weight, length);
    double carried = 0;
    for (const GapState& s : states) carried += s.force;
    const Ends ends = ends_of(analysis, *model);
    EXPECT_NEAR((ends.left.y + ends.right.y + carried) / weight, 1, 1e-9);
    EXPECT_NEAR(ends.left.x + ends.right.x, 0, 1e-9 * weight);
    // Rods from the left end to the first joint on the floor.
    int rods = 1;
    while (rods < count && !(states[at(rods - 1)].force > 0)) ++rods;
    ASSERT_LT(2 * rods, count);
    const std::vector<double> angle = angles_of(analysis, count);
    for (int k = rods; k < count - rods; ++k) EXPECT_NEAR(angle[at(k)], 0, 1e-9);
    for (int k = rods; k + 1 < count - rods; ++k) EXPECT_NEAR(states[at(k)].force, w, 1e-9 * weight) << k;
    const double flat = length / 2 - rods * l;
    const Lifted exact =
        solve_lifted(rods, l, w, height, flat, half, {-ends.left.x, w / 2 - states[at(rods - 1)].force});
    EXPECT_NEAR(-ends.left.x / exact.pull, 1, 1e-9);
    EXPECT_LE(std::abs(exact.lift), w / 2 * (1 + 1e-9));
    EXPECT_NEAR(states[at(rods - 1)].force, w / 2 - exact.lift, 1e-9 * weight);
    for (int k = 1; k <= rods; ++k) {
      EXPECT_NEAR(angle[at(rods - k)], -std::atan((exact.lift + (k - 0.5) * w) / exact.pull), 1e-9) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ChainOnAFloor, ::testing::Values(8, 25, 100, 1000));

TEST(OneSidedEconomy, ASmallChangeKeepsTheClosedGaps) {
  const auto model = chain_with_contacts(100, 4, 1.5, 0.8, 0.5, floor_contact());
  Equilibrium analysis(model);
  ASSERT_TRUE(analysis.solve().ok());
  const Counters before = analysis.evaluator().counters;
  auto heavier = std::make_shared<Model>(*model);
  for (auto& body : heavier->bodies) body.mass *= 1.001;
  analysis.set_model(heavier);
  const EquilibriumReport report = analysis.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.counters.symbolic, before.symbolic);
  // One Newton step, its verification and the certificate.
  EXPECT_LE(report.counters.factorizations - before.factorizations, 4);
}

class ChainOverADrum : public ::testing::TestWithParam<int> {};

TEST_P(ChainOverADrum, BalancesAndHangsAsTwoCatenaries) {
  const int count = GetParam();
  constexpr double length = 2.6, half = 1.1, radius = 0.5, mass = 0.1, w = mass * gravity_of_earth;
  const Vec2<double> centre{0, -0.3};
  const auto model = chain_with_contacts(count, length, half, 0, -0.3, drum_contact(centre, radius), mass);
  Equilibrium analysis(model);
  const EquilibriumReport report = analysis.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
  const std::vector<GapState> states = gap_states(analysis, *model);
  const double weight = count * w, l = length / count;
  expect_complementary(states, weight, length);
  // Joints and the contact forces on them, along the outward normals.
  const SystemState state = analysis.state();
  const Ends ends = ends_of(analysis, *model);
  Vec2<double> sum = ends.left + ends.right + Vec2<double>{0, -weight};
  int first = -1, last = -1;
  for (int k = 0; k + 1 < count; ++k) {
    const double phi = state.q[at(3 * k + 2)];
    const Vec2<double> joint{state.q[at(3 * k)] + l / 2 * std::cos(phi),
                             state.q[at(3 * k + 1)] + l / 2 * std::sin(phi)};
    sum += (states[at(k)].force / norm(joint - centre)) * (joint - centre);
    if (!(states[at(k)].force > 0)) continue;
    EXPECT_NEAR(norm(joint - centre), radius, 1e-10);
    if (first < 0) first = k;
    last = k;
  }
  ASSERT_GE(first, 1);
  ASSERT_GE(last - first, 1);
  EXPECT_NEAR(norm(sum) / weight, 0, 1e-9);
  // The pull along the free parts is that of their ends; tan of the angles grows by w / H a rod.
  const auto slope = [&](int k) { return std::tan(state.q[at(3 * k + 2)]); };
  for (int k = 1; k <= first; ++k) EXPECT_NEAR(slope(k) - slope(k - 1), -w / ends.left.x, 1e-9) << k;
  for (int k = last + 2; k < count; ++k) EXPECT_NEAR(slope(k) - slope(k - 1), w / ends.right.x, 1e-9) << k;
  EXPECT_NEAR(slope(0), -(ends.left.y - w / 2) / -ends.left.x, 1e-9);
  EXPECT_NEAR(slope(count - 1), (ends.right.y - w / 2) / ends.right.x, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ChainOverADrum, ::testing::Values(12, 26, 100, 1000));

}  // namespace
}  // namespace catena::testing
