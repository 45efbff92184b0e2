// Ends of straight guides, from how far a motion goes along them.
//
//   u = v^T (r_Pj - r_Pi),  v = A_i axis / |axis|        guide from min u - margin to max u + margin
//
// Every pose that will be shown is observed, then the drawing takes the ends over. The margin is a tenth of the travel
// and at least `least_margin`, m, so that a guide is seen where nothing moves. A rack gets its teeth over that length.
// What of a moving body bears the guide goes on to P_i, where the body has its place for it.
#pragma once

#include <span>

#include "catena/base/frame.hpp"
#include "catena/drawing/shapes/drawing.hpp"

namespace catena {

void observe_guides(Drawing& drawing, std::span<const Frame<double>> frames);
void fit_guides(Drawing& drawing, double least_margin);

}  // namespace catena
