// Buckling under loads that depend on the parameter in any way, against dense algebra and a scan of their own.
#include <gtest/gtest.h>

#include "oracles/buckling_columns.hpp"

namespace catena::testing {
namespace {

TEST(BucklingOfColumns, IsThatOfDenseAlgebraWhateverTheLaw) {
  for (unsigned seed = 1; seed <= 200; ++seed) EXPECT_EQ(compare_buckling(seed), "");
}

}  // namespace
}  // namespace catena::testing
