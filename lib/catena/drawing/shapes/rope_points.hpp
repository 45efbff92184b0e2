// The corners of a rope at a configuration: straight from circle to circle, along arcs on them.
//
//   u = (l h - D R h) / h^T h,  h = c_2 - c_1,  D = r_2 - r_1,  l = sqrt(h^T h - D^2)      (rope_span.hpp)
//   leaves circle 1 at c_1 - r_1 R u, comes to circle 2 at c_2 - r_2 R u, touches a circle from the u before to the u
//   after
//
// c centres, m; r radii, m, positive where the circle lies on the left of the rope; R turns by a quarter. A rope of
// which more than a turn is wound on a circle shows the part of a turn. Where one circle holds the next there is no
// straight line: its corners are not finite, which ends a line. A circle that the rope would have to cross itself to
// touch is passed (model/rope_layout.hpp). The number of corners depends on the nodes alone: where a circle is passed
// the last one is repeated. The page does the same in apps/viewer/src/rope.ts.
#pragma once

#include <span>

#include "catena/base/frame.hpp"
#include "catena/drawing/shapes/drawing.hpp"

namespace catena {

/// `frames` are those of the bodies' centroids, model order.
std::vector<Vec2<double>> rope_points(const RopePath& rope, std::span<const Frame<double>> frames);

}  // namespace catena
