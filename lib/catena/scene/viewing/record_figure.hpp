// Figures and plots of a recorded run: which poses, which columns.
//
// What cannot be drawn throws FigureError, whose text names what is asked for and what there is.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "catena/drawing/figures/plot.hpp"
#include "catena/scene/viewing/run_recorder.hpp"

namespace catena {

struct FigureError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class FigureFormat { svg, pdf };

struct DrawRequest {
  int analysis = 0;          ///< from 1; 0: the last one that has poses
  std::vector<double> at{};  ///< instants, s, a pose each; none: see `poses`
  int poses = 1;             ///< evenly spread over the rows; one: the first row of a motion, else the last row
  std::vector<std::string> traces{};  ///< points whose paths are shown: body.point, or a body's origin
  double width = 480;                 ///< points of 1/72 inch; the height of figures that are taller than wide
  FigureFormat format = FigureFormat::svg;
};

struct DrawnFigure {
  std::string file;
  std::vector<std::string> notes;  ///< what differs from what was asked for
};

DrawnFigure draw_record(const RunRecord& record, const DrawRequest& request);

struct DrawnFilm {
  FilmScale scale;
  std::vector<double> t;  ///< of every picture, s; NaN where the given configuration is shown
  std::vector<std::string> notes;
};

/// The poses asked for, each on a canvas of its own: `format` says nothing here.
DrawnFilm film_record(const RunRecord& record, const DrawRequest& request, const CanvasMaker& canvas);

struct PlotRequest {
  int analysis = 0;              ///< from 1; 0: the last one that has all columns
  std::string x{};               ///< empty: the first column
  std::vector<std::string> y{};  ///< empty: all but x
  bool log_x = false, log_y = false;
};

/// Columns of one unit share a panel.
Plot plot_record(const RunRecord& record, const PlotRequest& request);

CanvasMaker canvas_maker(FigureFormat format, std::string title);

}  // namespace catena
