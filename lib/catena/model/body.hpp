// A rigid body as the model keeps it: centroidal values, whatever frame its author used.
//
// The frame is at the centroid (apps/manual/constraints.md#coordinates). If the author's origin is elsewhere, `origin`
// is its place in the centroidal frame; every local coordinate was shifted when it was read, and columns shift back.
// Units: kg, kg m^2, m, rad, m/s, rad/s.
#pragma once

#include "catena/base/vec2.hpp"

namespace catena {

/// Body index of the ground.
inline constexpr int ground = -1;

template <class S>
struct BasicBody {
  S mass{}, inertia{};
  Vec2<S> position{};  ///< of the centroid, in the given configuration
  S angle{};
  Vec2<S> velocity{};  ///< of the author's origin; counts only where `velocity_given`
  S angular_velocity{};
  Vec2<S> origin{};  ///< the author's origin in the centroidal frame

  bool has_mass = false, has_inertia = false;
  bool velocity_given = false, angular_velocity_given = false;
  bool fixed = false;                                       ///< stays where it is given
  bool particle = false;                                    ///< its angle stays as given
  bool hold_x = false, hold_y = false, hold_angle = false;  ///< assembly may not change these

  int name = -1;         ///< number in the model's name table
  int first_point = -1;  ///< head of the list of its points
};

/// A body as its author describes it: everything optional but the name. `centroid` is the centroid's place in the
/// author's frame; position, velocity and all local coordinates refer to that frame's origin.
struct BodyValues {
  double mass = -1, inertia = -1;  ///< negative: not given
  Vec2<double> position{};
  double angle = 0;
  Vec2<double> centroid{};
  bool fixed = false, particle = false;
};

/// A named point of a body, local coordinates in the centroidal frame.
template <class S>
struct BasicPoint {
  int name;  ///< number in the model's table of point names
  int next;  ///< next point of the same body, or -1
  Vec2<S> local;
};

}  // namespace catena
