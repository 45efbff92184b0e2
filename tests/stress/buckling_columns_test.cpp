// Ten thousand columns under loads of six laws, at all scales of length, stiffness and parameter.
#include "oracles/buckling_columns.hpp"

#include <gtest/gtest.h>

#include "oracles/random_seeds.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

TEST(BucklingOfColumns, TenThousandOfThem) {
  expect_no_fault(first_case(1001), last_case(10000, 1001), [](unsigned seed) { return compare_buckling(seed); });
}

}  // namespace
}  // namespace catena::testing
