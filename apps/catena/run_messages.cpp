#include "run_messages.hpp"

#include <fmt/format.h>

#include "commands.hpp"

namespace catena::cli {

void show_progress(ProgressBar& bar, RunOptions& options) {
  if (!bar.visible()) return;
  options.progress = [&bar](const Progress& progress) {
    bar.update(fmt::format("{} {}/{}", progress.analysis, progress.number + 1, progress.analyses), progress.fraction);
  };
}

void complain_of_failures(const std::string& scene, const SceneOutcome& outcome) {
  for (const AnalysisResult& result : outcome.analyses) {
    if (!result.report.ok())
      complain(
          fmt::format("{}: {}: {}: {}\n", scene, result.type, to_string(result.report.status), result.report.message));
  }
}

}  // namespace catena::cli
