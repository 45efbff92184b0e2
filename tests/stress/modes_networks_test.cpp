// Ten thousand random oscillators: no mode lost, none invented, zeros exact, at 1e-9 ... 1e9 m, kg and N/m.
#include <gtest/gtest.h>

#include "oracles/modes_trial.hpp"

namespace catena::testing {
namespace {

TEST(ModesOfNetworks, TenThousandOfThem) {
  int wrong = 0;
  for (unsigned seed = 1001; seed <= 11000; ++seed) {
    const std::string difference = compare_modes(seed);
    wrong += !difference.empty();
    if (wrong < 20) {
      EXPECT_EQ(difference, "");
    }
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace catena::testing
