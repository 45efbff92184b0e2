// Every scene in data/scenes: runs to its end, says what it is, and shows a fact that is known about it.
#include <filesystem>

#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

namespace fs = std::filesystem;

const SceneFacts& facts() {
  static const SceneFacts all = [] {
    SceneFacts joined;
    for (const auto& part : {absolute_facts(), slider_facts(), four_bar_facts(), leg_facts(), machine_facts(),
                             gear_and_cam_facts(), force_facts(), gap_facts(), contact_facts(), design_facts()})
      joined.insert(part.begin(), part.end());
    return joined;
  }();
  return all;
}

TEST(DataScenes, EveryOneRunsAndShowsItsFact) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(CATENA_DATA_DIR "/scenes")) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    ++scenes;
    TextRun run;
    run.outcome = run_scene(entry.path().string(), {}, run.sink);
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text
                                        << (run.outcome.analyses.empty() ? ""
                                                                         : run.outcome.analyses.back().report.message);
    EXPECT_FALSE(run.sink.header.description.empty());
    EXPECT_FALSE(run.outcome.scene.empty());
    const auto fact = facts().find(name);
    if (fact == facts().end()) {
      ADD_FAILURE() << "no fact is tested about this scene";
    } else {
      fact->second(run);
    }
  }
  EXPECT_EQ(scenes, static_cast<int>(facts().size()));
}

}  // namespace
}  // namespace catena::testing
