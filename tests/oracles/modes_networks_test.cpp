// Modes of random rows, rings and grids of masses, trolleys and rods against dense matrices of their own.
#include <gtest/gtest.h>

#include "oracles/modes_trial.hpp"

namespace catena::testing {
namespace {

TEST(ModesOfNetworks, AreThoseOfDenseAlgebra) {
  for (unsigned seed = 1; seed <= 300; ++seed) EXPECT_EQ(compare_modes(seed), "");
}

}  // namespace
}  // namespace catena::testing
