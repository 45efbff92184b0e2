// How many digits are right, by their own claim, of what changes on its way: ropes that meet and leave pulleys, paths
// that pass flutter, and columns of bodies that are held. The quick share of stress/digits_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/sanitized.hpp"
#include "oracles/claimed_digits.hpp"
#include "stress/flutter_digits.hpp"
#include "stress/rope_digits.hpp"

namespace catena::testing {
namespace {

template <class Add>
void expect_claims_of_changes(const char* title, unsigned seeds, int least, Add&& add) {
  ClaimedDigits claims;
  int compared = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) compared += add(seed, claims) == "compared";
  EXPECT_GE(compared, least);
  claims.expect(title);
}

TEST(DigitsOfChanges, HoldWithRopesOnPulleys) {
  expect_claims_of_changes("ropes", size_of_test(40u, 12u), size_of_test(40, 12), add_rope_digits);
}
TEST(DigitsOfChanges, HoldOfPathsThatFlutter) {
  expect_claims_of_changes("flutter", size_of_test(40u, 12u), size_of_test(20, 5), add_flutter_digits);
}

// A body that three equations hold, not along the axes, beside a pendulum that swings: its velocity is what rounding
// makes of it, the same in both runs or not, and no digit of that is right.
TEST(DigitsOfChanges, HeldBodiesClaimNoneOfTheirVelocities) {
  int rounding = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double axis = random(-1, 1), x = random(0.5, 2), y = random(-2, 2), rate = random(-1, 1);
    const std::string pin = pair_of(x, y), along = pair_of(std::cos(axis), std::sin(axis));
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
        "held": {"mass": 3, "inertia": 1, "angle": 0.3, "position": )" +
                                 pin + R"(, "points": {"pin": [1, 0.2], "end": [0.4, 0.7]}},
        "bob": {"mass": 1, "inertia": 0.1, "position": )" +
                                 pair_of(x + 1.5, y) + R"(, "angular_velocity": )" + text_of(rate) + R"(}},
      "constraints": [{"type": "translational", "i": "ground", "j": "held", "axis_i": )" +
                                 along + R"(}, {"type": "absolute_distance", "i": "held.end", "ground": [-1, 0.4]},
        {"type": "revolute", "i": "held.pin", "j": "bob"}],
      "outputs": ["held.vx", "held.vy", "held.omega", "bob.omega"],
      "analyses": [{"type": "dynamics", "until": 1, "every": 0.25, "estimate_error": true}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double>& digits = run.analysis().digits;
    ASSERT_EQ(digits.size(), 5u);
    for (std::size_t k = 1; k < 4; ++k) {
      const std::vector<double> values = run.column(run.analysis().columns[k].name);
      const bool zero = std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
      if (zero) continue;
      ++rounding;
      EXPECT_EQ(digits[k], 0) << run.analysis().columns[k].name;
    }
    EXPECT_GT(digits[4], 6);
  }
  EXPECT_GE(rounding, 20);
}

}  // namespace
}  // namespace catena::testing
