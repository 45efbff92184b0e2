// A blow on a point of a body: an impulse in ground axes. Units: m, N s.
#pragma once

#include "catena/base/vec2.hpp"

namespace catena {

struct Strike {
  int body = -1;           ///< number in the model
  Vec2<double> point{};    ///< in the frame of its centroid
  Vec2<double> impulse{};  ///< in ground axes
};

}  // namespace catena
