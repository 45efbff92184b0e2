// The files of draw and plot: --svg, --pdf, or the standard output where none is named.
#pragma once

#include <functional>
#include <string>

#include "catena/scene/viewing/record_figure.hpp"

namespace CLI {
class App;
}

namespace catena::cli {

struct FigureFiles {
  std::string svg, pdf;

  bool named() const { return !svg.empty() || !pdf.empty(); }
};

/// `files` must live until the command line was read.
void add_figure_files(CLI::App& command, FigureFiles& files, const std::string& without);

/// Writes the files that are named, each made for its format, and says where; `solved`, or the exit code of the
/// failure.
int write_figures(const FigureFiles& files, const std::function<std::string(FigureFormat)>& make);

}  // namespace catena::cli
