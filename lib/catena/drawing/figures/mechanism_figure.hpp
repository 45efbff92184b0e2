// The mechanism itself as a figure: one pose, or several laid over each other, with the paths of points.
//
// The last pose is drawn in full; those before it are paler, the earlier the more, and without the supports. Symbols
// are `symbol_points` tall, smaller where links are short: a quarter of the typical link at most. The scale is equal in
// x and y and follows from everything that is shown. A film has a figure for every pose, all in one scale:
//
//   r = corner + (u, height - v) / scale        (u, v) a place on the page, from its upper left corner, points
//
// Lengths m, figure in points of 1/72 inch.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "catena/base/frame.hpp"
#include "catena/drawing/figures/vector_canvas.hpp"
#include "catena/drawing/shapes/drawing.hpp"

namespace catena {

/// Where the bodies are, and which forces act: one value a load of the drawing, in the axes that it names.
struct FigurePose {
  std::vector<Frame<double>> frames;
  std::vector<Vec2<double>> loads{};
};

struct MechanismFigure {
  double width = 480;        ///< points; a figure that is taller than wide has this height, and is narrower
  double symbol_points = 5;  ///< size of symbols
  std::vector<FigurePose> poses{};
  std::vector<std::vector<Vec2<double>>> traces{};  ///< paths of points, m
};

/// A canvas of the given width and height, points.
using CanvasMaker = std::function<std::unique_ptr<VectorCanvas>(double width, double height)>;

/// The file. `drawing` gets the ends of its guides from the poses. std::invalid_argument without a pose.
std::string draw_mechanism(Drawing drawing, const MechanismFigure& figure, const CanvasMaker& canvas);

/// Where the pages of a film lie in the ground frame.
struct FilmScale {
  Vec2<double> corner{};  ///< the lower left one, m
  double scale = 1;       ///< points a metre
  double width = 0, height = 0;
};

/// Draws every pose in full on a canvas of its own, one call of `canvas` each, with the traces. std::invalid_argument
/// without a pose.
FilmScale draw_film(Drawing drawing, const MechanismFigure& figure, const CanvasMaker& canvas);

}  // namespace catena
