// Parameters by which there is no derivative: null, with the reason, beside those by which there is one.
#include <cmath>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string warnings_of(const TextRun& run) {
  std::string all;
  for (const std::string& warning : run.analysis().report.warnings) all += warning + "\n";
  return all;
}

// A bob on two rods of one length side by side, that "l" lengthens both and "one" only one of them: hanging at rest the
// bob goes down with "l"; with "one" the rods contradict each other.
TEST(NoDerivative, OfOneOfTwoEqualRods) {
  const std::string text = R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"l": 2, "one": 2},
    "bodies": {"bob": {"mass": 1, "inertia": 1, "position": [0.1, -1.9]}},
    "constraints": [
      {"type": "absolute_angle", "name": "level", "i": "bob"},
      {"type": "absolute_distance", "name": "first", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l"},
      {"type": "absolute_distance", "name": "second", "i": ["bob", [0, 0]], "ground": [0, 0], "value": "=l+one-2"}],
    "analyses": [{"type": "sensitivity", "of": {"type": "equilibrium"}, "parameters": ["l", "one"], "mode": "forward"}]})";
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_NEAR(run.last("d(bob.y)/d(l)"), -1, 1e-9);
  EXPECT_TRUE(std::isnan(run.last("d(bob.y)/d(one)")));
  EXPECT_NE(warnings_of(run).find("depends on other constraints"), std::string::npos) << warnings_of(run);
}

// A bar on a pin at one end, held by a spring whose line passes through the pin: nothing resists its turning.
TEST(NoDerivative, OfAPlaceThatNothingHolds) {
  const std::string text = R"({"catena": 1, "gravity": [0, 0], "parameters": {"k": 10},
    "bodies": {"bar": {"mass": 1, "inertia": 1, "position": [0.3, 0.4], "angle": 0.2},
               "load": {"mass": 1, "inertia": 1, "position": [2, 0.1]}},
    "constraints": [{"type": "revolute", "name": "pin", "i": ["ground", [0, 0]], "j": ["bar", [-0.3, -0.4]]},
                    {"type": "absolute_angle", "name": "level", "i": "load"},
                    {"type": "absolute_y", "name": "guide", "i": ["load", [0, 0]]}],
    "forces": [{"type": "spring_damper", "name": "spring", "i": ["ground", [0, 0]], "j": ["load", [0, 0]], "k": "=k",
                "length": 1}],
    "analyses": [{"type": "sensitivity", "of": {"type": "equilibrium"}, "parameters": ["k"], "mode": "forward"}]})";
  const TextRun run = run_text(text);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_TRUE(std::isnan(run.last("d(bar.angle)/d(k)")));
  EXPECT_NE(warnings_of(run).find("neutral"), std::string::npos) << warnings_of(run);
}

}  // namespace
}  // namespace catena::testing
