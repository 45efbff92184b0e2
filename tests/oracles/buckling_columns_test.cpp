// Buckling under loads that depend on the parameter in any way, against dense algebra and a scan of their own.
#include "oracles/buckling_columns.hpp"

#include <gtest/gtest.h>

#include "analysis/sanitized.hpp"

namespace catena::testing {
namespace {

TEST(BucklingOfColumns, IsThatOfDenseAlgebraWhateverTheLaw) {
  for (unsigned seed = 1; seed <= size_of_test(60u, 20u); ++seed) EXPECT_EQ(compare_buckling(seed), "");
}

}  // namespace
}  // namespace catena::testing
