// Equilibria of mechanisms whose parts differ by orders of magnitude, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "catena/analysis/statics/equilibrium.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using testing::earth;

// Links of these lengths and 1 kg/m between pins at (0, 0) and (span, 0), laid out in a flat bow.
std::shared_ptr<Model> chain_of(const std::vector<double>& lengths, double span) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  double all = 0, from = 0;
  for (const double l : lengths) all += l;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    const double l = lengths[k], t = (from + l / 2) / all;
    from += l;
    model->add_body(
        "link" + std::to_string(k),
        {.mass = l, .inertia = l * l * l / 12, .position = {span * t, -span * t * (1 - t)}, .angle = 2.6 * (t - 0.5)});
    const int link = static_cast<int>(k);
    const double before = k == 0 ? 0 : lengths[k - 1] / 2;
    model->add("", Revolute<double>{{before, 0}, {-l / 2, 0}}, k == 0 ? ground : link - 1, link);
  }
  model->add("", Revolute<double>{{span, 0}, {lengths.back() / 2, 0}}, ground, static_cast<int>(lengths.size()) - 1);
  return model;
}

// The same links from left to right and back: each pin carries half of the weight, and the tangent of a link's angle is
// what hangs between it and the middle over the horizontal force, which a bisection finds.
long double tension_of(const std::vector<double>& lengths, double span) {
  long double low = 1e-9L, high = 1e9L, all = 0;
  for (const double l : lengths) all += l;
  for (int k = 0; k < 200; ++k) {
    const long double force = std::sqrt(low * high);
    long double reach = 0, before = 0;
    for (const double l : lengths) {
      const long double vertical = static_cast<long double>(earth) * (all / 2 - before - l / 2.0L);
      reach += l * force / std::sqrt(force * force + vertical * vertical);
      before += l;
    }
    (reach < span ? low : high) = force;
  }
  return low;
}

TEST(EquilibriumExtremes, LinksOverSixOrdersOfLength) {
  // Lengths of 1 m ... 1 um side by side, then in steps, then one short link among long ones.
  const std::vector<std::vector<double>> chains = {
      {1, 1e-6, 1e-3, 1e-5, 0.5, 1e-2, 1e-4, 1e-2, 0.5, 1e-5, 1e-3, 1e-6, 1},
      {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6},
      {1, 1, 1e-6, 1, 1},
  };
  for (std::size_t c = 0; c < chains.size(); ++c) {
    double all = 0;
    for (const double l : chains[c]) all += l;
    // The second chain's longest link leaves room for little.
    const double span = c == 1 ? 1.1 : 0.7 * all;
    Equilibrium chain(chain_of(chains[c], span));
    const EquilibriumReport report = chain.solve();
    ASSERT_TRUE(report.ok()) << c << ": " << report.message;
    EXPECT_TRUE(report.stable) << c;
    const auto tension = static_cast<double>(tension_of(chains[c], span));
    EXPECT_NEAR(chain.lambda()[0], tension, 1e-9 * tension) << c;
    EXPECT_NEAR(chain.lambda()[1], -earth * all / 2, 1e-9 * earth * all) << c;
  }
}

TEST(EquilibriumExtremes, SpringsInARowOverTwelveOrdersOfStiffness) {
  // Masses of 1 kg, one below the other; each spring carries all that hangs below it: its stretch is that over k. What
  // rounding does to the force of the stiffest one is more than many a soft one carries: 1e12 N/m times 1e-14 m.
  auto model = std::make_shared<Model>();
  model->gravity = {0, -earth};
  const int count = 13;
  const auto stiffness = [](int k) { return std::pow(10.0, (k * 5) % 13); };
  for (int k = 0; k < count; ++k) {
    model->add_body("mass" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {0.3, -1.0 * (k + 1)}});
    model->add_force("", testing::spring({0, 0}, {0, 0}, stiffness(k), 1), k == 0 ? ground : k - 1, k);
    // Particles do not turn.
    model->add("", AbsoluteAngle<double>{}, k, ground);
  }
  Equilibrium row(model);
  const EquilibriumReport report = row.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
  const std::vector<double> q = row.state().q;
  double above = 0, depth = 0;
  for (int k = 0; k < count; ++k) {
    const double stretch = earth * (count - k) / stiffness(k), y = q[3 * static_cast<std::size_t>(k) + 1];
    EXPECT_NEAR(q[3 * static_cast<std::size_t>(k)], 0, 1e-12 * 100) << k;
    depth += 1 + stretch;
    // Places are known to rounding of the extent, 130 m here.
    EXPECT_NEAR(above - y, 1 + stretch, 1e-13 * 130 + 1e-12 * stretch) << k;
    above = y;
  }
  EXPECT_NEAR(-above, depth, 1e-12 * depth);
}

TEST(EquilibriumExtremes, TorsionSpringsOverTwelveOrdersSideBySide) {
  // Bars on pins and springs of 1e-6 ... 1e6 N m/rad, each with a moment that turns its spring by 0.3 rad; the softest
  // mode is that of the softest spring, and none may be taken for free.
  auto model = std::make_shared<Model>();
  for (int k = 0; k <= 12; ++k) {
    const double stiffness = std::pow(10.0, k - 6);
    model->add_body("bar" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {1.0 * k, 0}});
    model->add("", Revolute<double>{{1.0 * k - 0.5, 0}, {-0.5, 0}}, ground, k);
    model->add_force("", testing::torsion_spring(stiffness, 0), ground, k);
    PointForce<double> load;
    load.s_i = {0.5, 0};
    model->add_force("", load, k, ground, {0, 0.3 * stiffness / std::cos(0.3)});
  }
  Equilibrium bars(model);
  const EquilibriumReport report = bars.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
  EXPECT_EQ(report.softest_mode.find("body \"bar0\" "), 0u) << report.softest_mode;
  for (std::size_t k = 0; k <= 12; ++k) EXPECT_NEAR(bars.state().q[3 * k + 2], 0.3, 1e-10) << k;
}

}  // namespace
}  // namespace catena
