// A share of the random balanced mechanisms of tests/stress.
#include "oracles/balanced_mechanisms.hpp"

namespace catena::testing {
namespace {

TEST(Balanced, StaysWhereItStands) { expect_to_stay(1, 400); }

TEST(Balanced, AMillionthShortIsUnstable) { expect_unstable_when_short(1, 200); }

TEST(Balanced, AnInvertedPendulumBesideFalls) { expect_a_pendulum_to_fall(1, 200); }

}  // namespace
}  // namespace catena::testing
