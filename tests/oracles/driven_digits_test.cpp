// How many digits of the columns of driven random mechanisms are right, by their own claim and by a solution in long
// double: the quick share of stress/digits_test.cpp.
#include "stress/driven_digits.hpp"

namespace catena::testing {
namespace {

TEST(DrivenDigits, AreThoseClaimed) {
  ClaimedDigits claims;
  int compared = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) compared += add_driven_digits(seed, claims) == "compared";
  EXPECT_GE(compared, 30);
  claims.expect("driven");
}

}  // namespace
}  // namespace catena::testing
