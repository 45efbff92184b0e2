// Columns over each other: what a plot shows, and the ways to draw it.
//
// A panel has one vertical axis; all panels share the horizontal one. A line goes through the plot's values of x, or
// through its own, as the lines of error over run time do. draw_plot() makes a figure for a paper, a line
// a column, with axes, units and a legend; braille_plot() draws with the 2 x 4 dots of braille letters in a terminal.
// Values that are not finite, and those a logarithmic axis cannot show, are gaps.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "catena/drawing/figures/mechanism_figure.hpp"

namespace catena {

struct PlotLine {
  std::string name;
  std::vector<double> y;
  std::vector<double> x{};  ///< one a value of y; empty: the plot's
  bool marks = false;       ///< a dot at every value
};

struct PlotPanel {
  std::string unit;  ///< of y; may be empty
  std::vector<PlotLine> lines;
  std::string name{};  ///< of y, where there are several lines; may be empty
};

struct Plot {
  std::string title;
  std::string x_name, x_unit;
  std::vector<double> x;
  std::vector<PlotPanel> panels;
  bool log_x = false, log_y = false;
};

/// The file; `width` and the height of a panel in points of 1/72 inch.
std::string draw_plot(const Plot& plot, double width, double panel_height, const CanvasMaker& canvas);

/// Lines of text, each ended; `columns` letters wide, `rows` lines of braille a panel. With `colours` the lines of a
/// panel are told apart by the colours of terminals, without them each gets a panel of its own.
std::string braille_plot(const Plot& plot, std::size_t columns, std::size_t rows, bool colours);

/// The horizontal places of a line's values.
inline const std::vector<double>& places_of(const Plot& plot, const PlotLine& line) {
  return line.x.empty() ? plot.x : line.x;
}
/// All that the horizontal axis is to show.
std::vector<double> all_places(const Plot& plot);

/// "crank.omega [rad/s]"; the name alone without a unit.
std::string with_unit(const std::string& name, const std::string& unit);

}  // namespace catena
