// The contract of a force element, on one page.
//
// An element is a struct template over the scalar S of its own parameters, with
//
//   type, summary, equation    as for constraints (element.hpp)
//   bodies                     1 or 2 (i, j; either may be the ground)
//   functions                  how many functions of time it reads (a magnitude, a pair of components, ...)
//   fields()                   what a scene file sets
//   force<T>(a, on_i, on_j)    adds the generalized forces Q on the bodies (about their centroids), T any scalar
//
// and from force alone the library derives stiffness -dQ/dq and damping -dQ/dqd by dual numbers. Optional members:
//
//   stiffness_pattern          which second derivatives of V may differ from zero (default: all)
//   stiffness(a, entries)      V_qq at those places, at rest; only asked where the element is conservative
//   potential<T>(a)            V with Q = -V_q at rest and functions frozen; present if the element can have one
//   conservative()             false where these parameters have no potential (a follower force); default: has
//   dissipation(a)             power lost to damping, W (default 0)
//   shares = true              its stiffness is in closed form, from a.shared, which the elements of one spring find
//   together (elastic_rope.hpp) complete(i, j), check(), can_leave_curve(), curve_use(a), draw(pen)    as for
//   constraints
//
// Frames may be given relative to any common origin; `ground` is where that origin lies. Units: N, N m, J, W.
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

/// Velocity of a body in the scalar T.
template <class T>
struct Twist {
  T vx{}, vy{}, omega{};
};

/// Generalized force on a body: force and moment about its centroid.
template <class T>
struct Wrench {
  T fx{}, fy{}, moment{};
};

/// What elements that are one spring find together at a configuration; see elastic_rope.hpp.
struct SharedStretch {
  double stretch = 0;               ///< m, zero while slack
  double g_i[3] = {}, g_j[3] = {};  ///< its gradient by the coordinates of bodies i and j of one element
};
inline constexpr SharedStretch no_stretch{};

template <class T>
struct ForceArguments {
  const Frame<T>& i;
  const Frame<T>& j;
  const Twist<T>& u;  ///< velocity of body i
  const Twist<T>& v;  ///< velocity of body j
  const T* f;         ///< values of the element's functions of time
  Vec2<double> ground;
  const SharedStretch* shared = &no_stretch;  ///< at these frames, of elements that share
};

/// Adds the force F at the arm A s' from a body's centroid: Q += [F; (R A s')^T F].
template <class T>
void add_force_at(const Vec2<T>& arm, const Vec2<T>& force, Wrench<T>& q) {
  q.fx += force.x;
  q.fy += force.y;
  q.moment += cross(arm, force);
}

template <class E>
consteval auto stiffness_pattern() {
  if constexpr (requires { E::stiffness_pattern; }) {
    return E::stiffness_pattern;
  } else {
    return full_lower_triangle<static_cast<std::size_t>(3 * E::bodies)>();
  }
}

template <class E>
concept HasClosedStiffness = requires(const E& e, const ForceArguments<double>& a, double* out) {
  e.stiffness(a, out);
};

/// One of several elements that are one spring: its stiffness is not the derivative of its own force alone.
template <class E>
concept Sharing = requires {
  requires E::shares;
};

template <class E>
concept HasPotential = requires(const E& e, const ForceArguments<double>& a) {
  e.potential(a);
};

template <class E>
bool is_conservative(const E& element) {
  if constexpr (requires { element.conservative(); }) {
    return element.conservative();
  } else {
    return HasPotential<E>;
  }
}

}  // namespace catena
