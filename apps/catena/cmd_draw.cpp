// catena draw: the mechanism as a vector figure, one pose or several over each other.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "figure_files.hpp"
#include "recorded_run.hpp"

namespace catena::cli {
namespace {

struct DrawCommand {
  SceneArguments scene;
  DrawRequest request;
  FigureFiles files;
};

int draw(const DrawCommand& command) {
  RecordedRun run;
  run_recorded(command.scene, {}, run.recorder, run);
  if (!run.usable()) return run.outcome.exit_code;
  std::vector<std::string> notes;
  const auto make = [&](FigureFormat format) {
    DrawRequest request = command.request;
    request.format = format;
    DrawnFigure figure = draw_record(run.recorder.record(), request);
    notes = std::move(figure.notes);  // the same for every format
    return std::move(figure.file);
  };
  int exit_code = run.outcome.exit_code;
  try {
    const int written = command.files.named() ? write_figures(command.files, make) : print(make(FigureFormat::svg));
    if (written != solved) exit_code = written;
  } catch (const FigureError& error) {
    complain(fmt::format("catena: {}\n", error.what()));
    return exit_code_without_figure(run);
  }
  for (const std::string& note : notes) complain(fmt::format("{}: {}\n", command.scene.scene, note));
  return exit_code;
}

}  // namespace

void add_draw_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("draw", "Draw the mechanism: SVG or PDF, one pose or several");
  const auto parsed = std::make_shared<DrawCommand>();
  add_scene_arguments(*command, parsed->scene);
  add_figure_files(*command, parsed->files, "without --svg and --pdf the SVG goes to the output");
  CLI::Option* at = command->add_option("--at", parsed->request.at, "instants, s: a pose at the row nearest to each");
  at->delimiter(',')->type_name("T");
  command->add_option("--poses", parsed->request.poses, "this many poses, evenly spread over the rows")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->excludes(at);
  command->add_option("--trace", parsed->request.traces, "points whose paths are drawn: body.point")
      ->delimiter(',')
      ->type_name("POINT");
  command->add_option("--analysis", parsed->request.analysis, "which analysis, from 1: the last one unless given")
      ->type_name("N");
  command
      ->add_option("--width", parsed->request.width,
                   "in points of 1/72 inch; of a figure that is taller than wide, the height")
      ->capture_default_str()
      ->type_name("W")
      ->check(CLI::Range(80.0, 5000.0));
  command->callback([parsed, &chosen] {
    static_cast<void>(parsed->scene.options());  // a wrong --set is told before anything runs
    chosen = [parsed] { return draw(*parsed); };
  });
}

}  // namespace catena::cli
