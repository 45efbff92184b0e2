// catena plot: columns over each other, in the terminal or as a vector figure for a paper.
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "catena/scene/writing/units_sink.hpp"
#include "figure_files.hpp"
#include "recorded_run.hpp"

namespace catena::cli {
namespace {

struct PlotCommand {
  SceneArguments scene;
  std::vector<std::string> units;
  PlotRequest request;
  FigureFiles files;
  std::string log;
  double width = 360, height = 150;  // points: a column of a paper
};

/// Columns that the run must give, where not all of its own are wanted.
std::vector<std::string> outputs_of(const PlotRequest& request) {
  std::vector<std::string> outputs = request.y;
  if (!outputs.empty() && !request.x.empty()) outputs.push_back(request.x);
  return outputs;
}

/// On the standard output: as wide as the terminal, in colours if it is one.
int print_braille(const Plot& plot) {
  const bool terminal = ::isatty(STDOUT_FILENO) == 1;
  std::size_t columns = 80;
  winsize window{};
  if (terminal && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 20) columns = window.ws_col;
  constexpr std::size_t rows = 10;
  return print(braille_plot(plot, columns, rows, terminal));
}

int plot(const PlotCommand& command) {
  RecordedRun run;
  UnitsSink shown(run.recorder, read_units(command.units));
  run_recorded(command.scene, outputs_of(command.request), shown, run);
  if (!run.usable()) return run.outcome.exit_code;
  int exit_code = run.outcome.exit_code;
  try {
    PlotRequest request = command.request;
    request.log_x = command.log.find('x') != std::string::npos;
    request.log_y = command.log.find('y') != std::string::npos;
    const Plot plot = plot_record(run.recorder.record(), request);
    const auto make = [&](FigureFormat format) {
      return draw_plot(plot, command.width, command.height, canvas_maker(format, plot.title));
    };
    const int written = command.files.named() ? write_figures(command.files, make) : print_braille(plot);
    if (written != solved) exit_code = written;
  } catch (const FigureError& error) {
    complain(fmt::format("catena: {}\n", error.what()));
    return exit_code_without_figure(run);
  }
  return exit_code;
}

}  // namespace

void add_plot_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("plot", "Plot columns: in the terminal, as SVG or PDF");
  const auto parsed = std::make_shared<PlotCommand>();
  add_scene_arguments(*command, parsed->scene);
  add_units(*command, parsed->units, "the axes");
  command->add_option("--x", parsed->request.x, "column of the horizontal axis: the first one unless given")
      ->type_name("COLUMN");
  command->add_option("--y", parsed->request.y, "columns, separated by commas: all unless given")
      ->delimiter(',')
      ->type_name("COLUMNS");
  add_figure_files(*command, parsed->files, "without --svg and --pdf it is drawn in the terminal");
  command->add_option("--log", parsed->log, "logarithmic axes")
      ->type_name("x|y|xy")
      ->check(CLI::IsMember({"x", "y", "xy"}));
  command->add_option("--analysis", parsed->request.analysis, "which analysis, from 1: the last one with these columns")
      ->type_name("N");
  command->add_option("--width", parsed->width, "of the figure, in points of 1/72 inch")
      ->capture_default_str()
      ->type_name("W")
      ->check(CLI::Range(120.0, 5000.0));
  command->add_option("--height", parsed->height, "of a panel, in points")
      ->capture_default_str()
      ->type_name("H")
      ->check(CLI::Range(60.0, 5000.0));
  command->callback([parsed, &chosen] {
    static_cast<void>(parsed->scene.options());  // what is wrong with --set and --units is told before anything runs
    static_cast<void>(read_units(parsed->units));
    chosen = [parsed] { return plot(*parsed); };
  });
}

}  // namespace catena::cli
