// Scenes that the schema allows, by the thousand; tests/scene runs the first of the kind.
#include "scene/schema_scenes.hpp"

#include "stress/cases.hpp"

namespace catena::testing {
namespace {

TEST(SchemaScenesLong, GiveResultsThatAreWellFormedAndTheSameAgain) {
  const int cases = stress_cases(5000);
  print_shares("scenes that the schema allows", run_schema_scenes(first_case(1000), cases, 60));
}

}  // namespace
}  // namespace catena::testing
