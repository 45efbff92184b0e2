// Five thousand paths of loaded particles at all scales.
#include <gtest/gtest.h>

#include "oracles/loaded_particles.hpp"
#include "oracles/random_seeds.hpp"

namespace catena::testing {
namespace {

TEST(PathsOfParticles, FiveThousandOfThem) {
  int ended = 0;
  expect_no_fault(1001, 6000, [&](unsigned seed) {
    const LoadedParticle particle(seed);
    std::string fault = particle.check();
    ended += particle.ended();
    return fault;
  });
  EXPECT_GE(ended, 4950);
}

}  // namespace
}  // namespace catena::testing
