// catena plot: columns over each other, in the terminal or as a vector figure for a paper.
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "catena/scene/viewing/record_figure.hpp"
#include "recorded_run.hpp"

namespace catena::cli {
namespace {

struct PlotCommand {
  SceneArguments scene;
  PlotRequest request;
  std::string svg, pdf, log;
  double width = 360, height = 150;  // points: a column of a paper
};

/// Columns that the run must give: time is there by itself.
std::vector<std::string> outputs_of(const PlotRequest& request) {
  std::vector<std::string> outputs;
  for (const std::string& name : request.y) {
    if (name != "t") outputs.push_back(name);
  }
  if (!request.y.empty() && !request.x.empty() && request.x != "t") outputs.push_back(request.x);
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
  run_recorded(command.scene, outputs_of(command.request), run);
  if (!run.usable()) return run.outcome.exit_code;
  int exit_code = run.outcome.exit_code;
  try {
    PlotRequest request = command.request;
    request.log_x = command.log.find('x') != std::string::npos;
    request.log_y = command.log.find('y') != std::string::npos;
    const Plot plot = plot_record(run.recorder.record(), request);
    for (const auto& [path, format] :
         {std::pair(command.svg, FigureFormat::svg), std::pair(command.pdf, FigureFormat::pdf)}) {
      if (path.empty()) continue;
      const std::string file = draw_plot(plot, command.width, command.height, canvas_maker(format, plot.title));
      if (const int written = write_file(path, file); written != solved) exit_code = written;
    }
    if (command.svg.empty() && command.pdf.empty()) {
      if (const int printed = print_braille(plot); printed != solved) exit_code = printed;
    }
  } catch (const FigureError& error) {
    complain(fmt::format("catena: {}\n", error.what()));
    return usage;
  }
  return exit_code;
}

}  // namespace

void add_plot_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("plot", "Plot columns: in the terminal, as SVG or PDF");
  const auto parsed = std::make_shared<PlotCommand>();
  add_scene_arguments(*command, parsed->scene);
  command->add_option("--x", parsed->request.x, "column of the horizontal axis: the first one unless given")
      ->type_name("COLUMN");
  command->add_option("--y", parsed->request.y, "columns, separated by commas: all unless given")
      ->delimiter(',')
      ->type_name("COLUMNS");
  command->add_option("--svg", parsed->svg, "write a figure to this file")->type_name("FILE");
  command->add_option("--pdf", parsed->pdf, "the same as PDF")->type_name("FILE");
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
    static_cast<void>(parsed->scene.options());  // a wrong --set is told before anything runs
    chosen = [parsed] { return plot(*parsed); };
  });
}

}  // namespace catena::cli
