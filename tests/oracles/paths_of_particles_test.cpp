// Paths of loaded particles on springs: every row balances, every row lies on the path of the row before.
#include <gtest/gtest.h>

#include "analysis/sanitized.hpp"
#include "oracles/loaded_particles.hpp"

namespace catena::testing {
namespace {

TEST(PathsOfParticles, BalanceAndStayOnTheirPath) {
  int ended = 0;
  for (unsigned seed = 1; seed <= size_of_test(16u, 4u); ++seed) {
    const LoadedParticle particle(seed);
    EXPECT_EQ(particle.check(), "") << seed;
    ended += particle.ended();
  }
  EXPECT_GE(ended, size_of_test(15, 3));
}

// Paths that come by a fixed end of a spring, where it is as stiff as it is short: what seems rounding by that
// stiffness is not all of it.
TEST(PathsOfParticles, BalanceBesideTheEndOfASpring) {
  for (const unsigned seed : {20330u, 20477u}) {
    EXPECT_EQ(LoadedParticle(seed).check(), "") << seed;
  }
}

}  // namespace
}  // namespace catena::testing
