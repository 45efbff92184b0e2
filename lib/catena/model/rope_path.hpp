// The way of a rope as a model keeps it for figures: the circles and points that it passes, one after the other. No
// analysis depends on it; its elements have the straight stretches alone (rope_way.hpp).
//
// Local coordinates in the centroidal frames, m.
#pragma once

#include <vector>

#include "catena/base/vec2.hpp"
#include "catena/model/body.hpp"

namespace catena {

/// A circle, or with radius zero a point.
struct RopeNode {
  int body = ground;
  Vec2<double> centre{};
  double radius = 0;  ///< positive where the circle lies on the left of the rope as it runs on, else negative
  bool rolls = false;
};

/// The part of a rope's way that one element stands for.
struct RopePath {
  int element = -1;
  std::vector<RopeNode> nodes{};
  /// The last node belongs to the next part of the rope: it says how far this one touches the circle before.
  bool leads_on = false;
};

}  // namespace catena
