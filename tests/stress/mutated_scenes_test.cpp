// Ten thousand scenes with mistakes in them; tests/scene runs the first of the kind.
#include "scene/mutated_scenes.hpp"

#include "stress/cases.hpp"

namespace catena::testing {
namespace {

TEST(MutatedScenesLong, EndWithWordsNotWithACrash) { run_mutated_scenes(stress_cases(10000), first_case(1000), 60); }

}  // namespace
}  // namespace catena::testing
