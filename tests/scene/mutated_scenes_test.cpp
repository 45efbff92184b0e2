#include "scene/mutated_scenes.hpp"

namespace catena::testing {
namespace {

TEST(MutatedScenes, EndWithWordsNotWithACrash) { run_mutated_scenes(120, 1, 20); }

}  // namespace
}  // namespace catena::testing
