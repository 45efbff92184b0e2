// Ten thousand scenes with mistakes in them; tests/scene runs the first of the kind.
#include "scene/mutated_scenes.hpp"

namespace catena::testing {
namespace {

TEST(MutatedScenesLong, EndWithWordsNotWithACrash) { run_mutated_scenes(10000, 1000, 60); }

}  // namespace
}  // namespace catena::testing
