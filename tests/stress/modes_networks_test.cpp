// Ten thousand random oscillators: no mode lost, none invented, zeros exact, at 1e-9 ... 1e9 m, kg and N/m.
#include <gtest/gtest.h>

#include "oracles/modes_trial.hpp"
#include "oracles/random_seeds.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

TEST(ModesOfNetworks, TenThousandOfThem) {
  expect_no_fault(first_case(1001), last_case(10000, 1001), [](unsigned seed) { return compare_modes(seed); });
}

}  // namespace
}  // namespace catena::testing
