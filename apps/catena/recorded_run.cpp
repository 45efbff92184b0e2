#include "recorded_run.hpp"

#include <cstdio>

#include "catena/results/terminal/interrupt.hpp"
#include "run_messages.hpp"

namespace catena::cli {

void run_recorded(const SceneArguments& arguments, const std::vector<std::string>& outputs, ResultSink& results,
                  RecordedRun& run) {
  RunOptions options = arguments.options();
  options.outputs = outputs;
  options.poses = &run.recorder;
  options.cancel = &interrupt_flag();
  ProgressBar bar(true);
  show_progress(bar, options);
  catch_interrupts();
  run.outcome = run_scene(arguments.scene, options, results);
  interrupt_was_noticed();
  bar.clear();
  std::fputs(run.outcome.error_text.c_str(), stderr);
  complain_of_failures(arguments.scene, run.outcome);
}

}  // namespace catena::cli
