// The way of a rope as a model keeps it: the circles and points that it passes, one after the other, for figures, for
// ways that change (rope_routes.hpp) and for friction on pulleys (rope_grips.hpp). Its elements have the straight
// stretches alone (rope_way.hpp).
//
// Local coordinates in the centroidal frames, m.
#pragma once

#include <numbers>
#include <vector>

#include "catena/base/vec2.hpp"
#include "catena/model/body.hpp"

namespace catena {

/// An angle of contact above this one, rad, belongs to a rope that lies beside the circle, if both its stretches are
/// long enough to cross behind it: its ends would lean by more than 60 degrees behind half a turn (rope_layout.hpp).
inline constexpr double most_contact_of_ropes = 4 * std::numbers::pi / 3;

/// A circle, or with radius zero a point.
struct RopeNode {
  int body = ground;
  Vec2<double> centre{};
  double radius = 0;  ///< positive where the circle lies on the left of the rope as it runs on, else negative
  bool rolls = false;
  double mu = 0;  ///< of the friction of a rope that slides over it
};

/// The part of a rope's way that one element stands for.
struct RopePath {
  int element = -1;
  std::vector<RopeNode> nodes{};
  /// The last node belongs to the next part of the rope: it says how far this one touches the circle before.
  bool leads_on = false;
};

}  // namespace catena
