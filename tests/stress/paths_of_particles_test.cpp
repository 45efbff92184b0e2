// Five thousand paths of loaded particles at all scales.
#include <gtest/gtest.h>

#include "oracles/loaded_particles.hpp"

namespace catena::testing {
namespace {

TEST(PathsOfParticles, FiveThousandOfThem) {
  int wrong = 0, ended = 0;
  for (unsigned seed = 1001; seed <= 6000; ++seed) {
    const LoadedParticle particle(seed);
    const std::string fault = particle.check();
    wrong += !fault.empty();
    ended += particle.ended();
    if (wrong < 20) {
      EXPECT_EQ(fault, "") << seed;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(ended, 4950);
}

}  // namespace
}  // namespace catena::testing
