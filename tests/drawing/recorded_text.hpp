// Runs a scene given as text, and keeps what figures and pages are made of.
#pragma once

#include <fstream>
#include <memory>
#include <string>

#include "catena/scene/running/scene_runner.hpp"
#include "catena/scene/viewing/run_recorder.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {

struct RecordedText {
  std::unique_ptr<RunRecorder> recorder;
  SceneOutcome outcome;

  const RunRecord& record() const { return recorder->record(); }
};

inline RecordedText record_text(const std::string& text, const RecordLimits& limits = {}, int threads = 1) {
  TemporaryFolder folder;
  const std::string path = folder / "scene.json";
  std::ofstream(path, std::ios::binary) << text;
  RecordedText run{std::make_unique<RunRecorder>(limits), {}};
  RunOptions options;
  options.poses = run.recorder.get();
  options.threads = threads;
  run.outcome = run_scene(path, options, *run.recorder);
  return run;
}

}  // namespace catena::testing
