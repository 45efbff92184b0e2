#include "recorded_run.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "catena/results/interrupt.hpp"
#include "catena/results/progress_bar.hpp"

namespace catena::cli {

void run_recorded(const SceneArguments& arguments, const std::vector<std::string>& outputs, RecordedRun& run) {
  RunOptions options = arguments.options();
  options.outputs = outputs;
  options.poses = &run.recorder;
  options.cancel = &interrupt_flag();
  ProgressBar bar(true);
  if (bar.visible()) {
    options.progress = [&](const Progress& progress) {
      bar.update(fmt::format("{} {}/{}", progress.analysis, progress.number + 1, progress.analyses), progress.fraction);
    };
  }
  catch_interrupts();
  run.outcome = run_scene(arguments.scene, options, run.recorder);
  interrupt_was_noticed();
  bar.clear();
  std::fputs(run.outcome.error_text.c_str(), stderr);
  for (const AnalysisResult& result : run.outcome.analyses) {
    if (!result.report.ok())
      complain(fmt::format("{}: {}: {}: {}\n", arguments.scene, result.type, to_string(result.report.status),
                           result.report.message));
  }
}

int write_file(const std::string& path, std::string_view content) {
  TextOutput output = TextOutput::file(path);
  output.write(content);
  if (!output.commit()) {
    complain(fmt::format("catena: {}\n", output.error()));
    return no_file;
  }
  complain(fmt::format("wrote {}\n", path));
  return solved;
}

}  // namespace catena::cli
