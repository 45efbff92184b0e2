// What every command that runs a scene says on the standard error: how far it is, and which analyses failed.
#pragma once

#include <string>

#include "catena/results/terminal/progress_bar.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena::cli {

/// The run tells the bar how far it is, if it is shown. `bar` must outlive the run.
void show_progress(ProgressBar& bar, RunOptions& options);

/// One line an analysis that failed: the scene, its type, its status and why.
void complain_of_failures(const std::string& scene, const SceneOutcome& outcome);

}  // namespace catena::cli
