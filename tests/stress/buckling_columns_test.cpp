// Ten thousand columns under loads of six laws, at all scales of length, stiffness and parameter.
#include "oracles/buckling_columns.hpp"

#include <gtest/gtest.h>

#include "oracles/random_seeds.hpp"

namespace catena::testing {
namespace {

TEST(BucklingOfColumns, TenThousandOfThem) {
  expect_no_fault(1001, 11000, [](unsigned seed) { return compare_buckling(seed); });
}

}  // namespace
}  // namespace catena::testing
