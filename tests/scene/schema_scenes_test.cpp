#include "scene/schema_scenes.hpp"

namespace catena::testing {
namespace {

TEST(SchemaScenes, GiveResultsThatAreWellFormedAndTheSameAgain) {
  Outcomes seen = run_schema_scenes(1, 100, 20);
  // The generator is to make scenes that run, not only mistakes.
  EXPECT_GT(seen["ok"], 10);
  EXPECT_LT(seen["not valid"], 90);
}

}  // namespace
}  // namespace catena::testing
