// How many digits of the columns of random mechanisms are right, by their own claim and by a solution in long double:
// the quick share of stress/digits_test.cpp, which has motions under forces as well.
#include "stress/driven_digits.hpp"
#include "stress/resting_digits.hpp"

namespace catena::testing {
namespace {

template <class Add>
void expect_claims(const char* title, unsigned seeds, int least, Add&& add) {
  ClaimedDigits claims;
  int compared = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) compared += add(seed, claims) == "compared";
  EXPECT_GE(compared, least);
  claims.expect(title);
}

TEST(ClaimedDigits, HoldInDrivenMotion) { expect_claims("driven", 40, 20, add_driven_digits); }
TEST(ClaimedDigits, HoldAtRest) { expect_claims("at rest", 40, 5, add_resting_digits); }

}  // namespace
}  // namespace catena::testing
