#include "figure_files.hpp"

#include <CLI/CLI.hpp>

#include "recorded_run.hpp"

namespace catena::cli {

void add_figure_files(CLI::App& command, FigureFiles& files, const std::string& without) {
  command.add_option("--svg", files.svg, "write the figure to this file; " + without)->type_name("FILE");
  command.add_option("--pdf", files.pdf, "the same as PDF")->type_name("FILE");
}

int write_figures(const FigureFiles& files, const std::function<std::string(FigureFormat)>& make) {
  int exit_code = solved;
  for (const auto& [path, format] :
       {std::pair(files.svg, FigureFormat::svg), std::pair(files.pdf, FigureFormat::pdf)}) {
    if (path.empty()) continue;
    if (const int written = write_file(path, make(format)); written != solved) exit_code = written;
  }
  return exit_code;
}

}  // namespace catena::cli
