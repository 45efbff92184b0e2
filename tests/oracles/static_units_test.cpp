// Equilibria in other units and far off the origin. Where units differ by powers of two every number of the computation
// has the same digits as long as no length, force or stiffness comes from anywhere but the scene: answers are then
// equal.
#include <gtest/gtest.h>

#include <cmath>

#include "catena/analysis/statics/equilibrium.hpp"
#include "oracles/random_statics.hpp"

namespace catena::testing {
namespace {

struct Answer {
  EquilibriumReport report;
  std::vector<double> q;  // in units, relative to the origin
};

Answer solve(unsigned seed, bool linkage, const StaticScale& scale) {
  RandomStatics random(seed, scale);
  Equilibrium analysis(linkage ? random.linkage() : random.network());
  Answer answer{analysis.solve(), analysis.state().q};
  for (std::size_t k = 0; k < answer.q.size(); ++k) {
    if (k % 3 == 2) continue;
    answer.q[k] = (answer.q[k] - (k % 3 == 0 ? scale.origin.x : scale.origin.y)) / scale.length;
  }
  return answer;
}

void compare(int cases, const StaticScale& scale, double tolerance) {
  for (int k = 0; k < cases; ++k) {
    for (const bool linkage : {false, true}) {
      const auto seed = static_cast<unsigned>(9000 + k);
      const Answer given = solve(seed, linkage, {}), scaled = solve(seed, linkage, scale);
      ASSERT_EQ(given.report.status, scaled.report.status) << seed << ": " << scaled.report.message;
      EXPECT_EQ(given.report.stable, scaled.report.stable) << seed;
      for (std::size_t i = 0; i < given.q.size(); ++i) {
        EXPECT_NEAR(given.q[i], scaled.q[i], tolerance * (1 + std::abs(given.q[i]))) << seed << ", " << i;
      }
    }
  }
}

TEST(StaticUnits, DoNotMatterFromNanometresToAMillionKilometres) {
  for (const double length : {std::pow(2.0, -30), std::pow(2.0, 30)}) compare(12, {.length = length}, 1e-12);
}

TEST(StaticUnits, ForcesOverEighteenOrdersDoNotMatter) {
  for (const double force : {std::pow(2.0, -30), std::pow(2.0, 30)}) compare(12, {.force = force}, 1e-12);
}

TEST(StaticUnits, TheOriginDoesNotMatter) {
  // Places in the ground are given to 1e-10 m there.
  compare(12, {.origin = {1e6, -2e6}}, 1e-6);
}

}  // namespace
}  // namespace catena::testing
