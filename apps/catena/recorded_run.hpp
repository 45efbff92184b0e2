// A scene's run kept in memory for draw, plot and view, with its messages on the standard error.
#pragma once

#include <string>

#include "catena/scene/viewing/run_recorder.hpp"
#include "commands.hpp"
#include "scene_arguments.hpp"

namespace catena::cli {

struct RecordedRun {
  RunRecorder recorder;
  SceneOutcome outcome;

  /// Whether there is anything to show: the scene could be read.
  bool usable() const { return recorder.record().model != nullptr; }
};

/// Runs the scene's analyses, with these columns in place of its own unless there are none. `results`: the recorder, or
/// what changes results on their way to it. What went wrong has been said when it returns.
void run_recorded(const SceneArguments& arguments, const std::vector<std::string>& outputs, ResultSink& results,
                  RecordedRun& run);

/// The exit code of a command whose figure cannot be made: where the run failed, that is why.
inline int exit_code_without_figure(const RecordedRun& run) {
  return run.outcome.exit_code == solved ? usage : run.outcome.exit_code;
}

}  // namespace catena::cli
