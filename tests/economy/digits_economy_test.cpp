// What it costs to tell how many digits are right, and that a scene which does not ask for them does not pay: counted
// by what is asked of the heap, which a second run asks for once more.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "economy/allocations.hpp"
#include "scene/run_text.hpp"

namespace catena {
namespace {

using testing::allocations;
using testing::run_text;
using testing::TextRun;

/// Allocations of the second of two such runs.
long counted(const std::string& method, bool digits) {
  const std::string text = R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
        "a": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1},
        "b": {"rod": {"from": [1, 0], "to": [2, 0]}, "mass": 1}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "a.from"},
                      {"type": "revolute", "i": "a.to", "j": "b.from"}],
      "outputs": ["a.angle"], "analyses": [{"type": "dynamics", "until": 1, "method": ")" +
                           method + R"(", "digits": )" + (digits ? "true" : "false") + "}]}";
  run_text(text);
  const long before = allocations;
  const TextRun run = run_text(text);
  EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(run.analysis().digits.empty(), !digits);
  return allocations - before;
}

// Neither a second run is made where none are asked for, nor, where one run is enough, the error carried along it.
TEST(DigitsEconomy, NothingIsPaidWhereNoneAreAskedFor) {
  for (const std::string method : {"adams", "baumgarte", "partitioning", "rk8"}) {
    const long with = counted(method, true), without = counted(method, false);
    std::printf("%s: %ld allocations with digits, %ld without\n", method.c_str(), with, without);
    EXPECT_GT(with, 1.2 * without) << method;
  }
}

}  // namespace
}  // namespace catena
