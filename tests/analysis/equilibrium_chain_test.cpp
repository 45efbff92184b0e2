// Hanging chains against the exact discrete catenary, from near and from hopeless starts.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analysis/sanitized.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "oracles/static_reference.hpp"
#include "oracles/static_scenes.hpp"

namespace catena {
namespace {

using testing::ChainStart;

// Multipliers are minus the force on body j of a pin: the ground's pins have the chain as j.
void expect_catenary(int count, const EquilibriumReport& report, const Equilibrium& chain, double tolerance) {
  const auto reference = testing::reference_values("discrete_catenary").at("N" + std::to_string(count));
  ASSERT_TRUE(report.ok()) << report.message;
  EXPECT_TRUE(report.stable);
  EXPECT_EQ(report.negative_modes, 0);
  const double tension = reference.at("horizontal_tension_H"), energy = reference.at("potential_energy");
  const int left = chain.plan().element_row[0], right = chain.plan().element_row[static_cast<std::size_t>(count)];
  EXPECT_NEAR(chain.lambda()[static_cast<std::size_t>(left)], tension, tolerance * tension);
  EXPECT_NEAR(chain.lambda()[static_cast<std::size_t>(right)], -tension, tolerance * tension);
  EXPECT_NEAR(chain.lambda()[static_cast<std::size_t>(left) + 1], -4.905, 5 * tolerance);
  EXPECT_NEAR(chain.lambda()[static_cast<std::size_t>(right) + 1], -4.905, 5 * tolerance);
  EXPECT_NEAR(report.energy, energy, -tolerance * energy);
  const std::vector<double> q = chain.state().q;
  const double half = 0.75 / count;
  for (const auto& [name, place] : reference.at("joints").items()) {
    const int joint = std::stoi(name.substr(1));
    if (joint == 0) continue;
    const double* body = &q[3 * static_cast<std::size_t>(joint - 1)];
    EXPECT_NEAR(body[0] + half * std::cos(body[2]), place.at(0).get<double>(), tolerance) << name;
    EXPECT_NEAR(body[1] + half * std::sin(body[2]), place.at(1).get<double>(), tolerance) << name;
  }
}

class Catenary : public ::testing::TestWithParam<int> {};

TEST_P(Catenary, HangsAsInTheReferenceFromAllKindsOfStarts) {
  const int count = GetParam();
  for (const ChainStart start : {ChainStart::sag, ChainStart::zigzag, ChainStart::above, ChainStart::reversed,
                                 ChainStart::straight, ChainStart::vertical}) {
    SCOPED_TRACE(static_cast<int>(start));
    Equilibrium chain(testing::hanging_chain(count, start));
    expect_catenary(count, chain.solve(), chain, 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Links, Catenary, ::testing::Values(4, 10, 100, 1000, 10000));

TEST(CatenaryFromRandomAngles, AlwaysEndsInTheStableSolution) {
  const double tension = testing::reference_values("discrete_catenary").at("N100").at("horizontal_tension_H");
  for (const ChainStart start : {ChainStart::random_walk, ChainStart::scattered}) {
    for (unsigned seed = 1; seed <= testing::size_of_test(200u, 60u); ++seed) {
      Equilibrium chain(testing::hanging_chain(100, start, seed));
      const EquilibriumReport report = chain.solve();
      ASSERT_TRUE(report.ok()) << seed << ": " << report.message;
      EXPECT_TRUE(report.stable) << seed;
      EXPECT_NEAR(chain.lambda()[0], tension, 1e-12 * tension) << seed;
    }
  }
}

TEST(CatenaryAtTheExtremes, SpanAlmostNothingAndAlmostTheLength) {
  // tan(angle) is linear in the link's number: a bisection for the horizontal force in long double is the oracle.
  for (const double span : {0.15, 1.5 * 0.9999}) {
    const int count = 60;
    Equilibrium chain(testing::hanging_chain(count, ChainStart::sag, 1, 1.5, 1, span));
    const EquilibriumReport report = chain.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_TRUE(report.stable);
    long double low = 1e-6L, high = 1e6L;
    for (int k = 0; k < 200; ++k) {
      const long double force = std::sqrt(low * high);
      long double reach = 0;
      for (int i = 0; i < count; ++i) {
        const long double v = 9.81L / count * (i - (count - 1) / 2.0L);
        reach += 1.5L / count * force / std::sqrt(force * force + v * v);
      }
      (reach < span ? low : high) = force;
    }
    EXPECT_NEAR(chain.lambda()[0], static_cast<double>(low), 1e-10 * static_cast<double>(low)) << span;
  }
}

TEST(ChainWithSideForce, TakesTheClosedForm) {
  const auto check = [](const std::string& file, double length, double mass, double force) {
    const auto references = testing::reference_values(file);
    for (const auto& [name, reference] : references.items()) {
      const int count = reference.at("N");
      Equilibrium chain(testing::chain_with_side_force(count, length, mass, force));
      const EquilibriumReport report = chain.solve();
      ASSERT_TRUE(report.ok()) << name << ": " << report.message;
      EXPECT_TRUE(report.stable) << name;
      const std::vector<double> q = chain.state().q;
      const double* tip = &q[q.size() - 3];
      const double half = length / count / 2;
      EXPECT_NEAR(tip[0] + half * std::cos(tip[2]), reference.at("tip").at(0).get<double>(), 1e-10 * length) << name;
      EXPECT_NEAR(tip[1] + half * std::sin(tip[2]), reference.at("tip").at(1).get<double>(), 1e-10 * length) << name;
      EXPECT_NEAR(q[2], reference.at("phi_1").get<double>(), 1e-10) << name;
      EXPECT_NEAR(tip[2], reference.at("phi_N").get<double>(), 1e-10) << name;
      EXPECT_NEAR(chain.lambda()[0], force, 1e-10 * force) << name;
      EXPECT_NEAR(chain.lambda()[1], -mass * testing::earth, 1e-10 * force) << name;
    }
  };
  check("hanging_chain_side_force", 1, 1, 5);
  check("hanging_chain_side_force_b", 2.75, 4.1, 33);
}

}  // namespace
}  // namespace catena
