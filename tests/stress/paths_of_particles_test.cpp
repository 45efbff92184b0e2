// Five thousand paths of loaded particles at all scales.
#include <gtest/gtest.h>

#include "oracles/loaded_particles.hpp"
#include "oracles/random_seeds.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

TEST(PathsOfParticles, FiveThousandOfThem) {
  int ended = 0;
  expect_no_fault(first_case(1001), last_case(5000, 1001), [&](unsigned seed) {
    const LoadedParticle particle(seed);
    std::string fault = particle.check();
    ended += particle.ended();
    return fault;
  });
  EXPECT_GE(ended, stress_cases(5000) * 99 / 100);
}

}  // namespace
}  // namespace catena::testing
