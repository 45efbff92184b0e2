// A straight stretch of a rope between two circles, or points, of two bodies, with its part of the arcs on them.
//
//   f = l + (R_i - R_j) theta + a_i phi_i + a_j phi_j + c        l = sqrt(h^T h - D^2),  D = R_j - R_i,  h = r_Pj -
//   r_Pi u = (l h - D R h) / h^T h        theta: angle of u        f_qi = [-u^T, -A_i s'Pi x u + a_i]   (of j alike)
//   fdd = u^T hdd + (R u . hd)^2 / l  + (accelerations' part)
//
// Symbols: s'Pi, s'Pj centres, m; R_i, R_j radii, m, positive where the circle lies on the left of the rope as it runs
// from i to j, zero for a point; u unit vector along the stretch. On a pulley that the rope slides over, the arc
// R (theta_out - theta_in) has one term with each of its neighbours: the length of a whole rope is a sum over pairs of
// bodies. a_i, a_j: a pulley that rolls winds R phi on and off. theta is continuous within half a turn of `direction`,
// that of the given configuration. Singular where one circle holds the other (l = 0). Source: tangents of circles, with
// u^T (R u) = 0, so that df = u^T dh.
#pragma once

#include <cmath>
#include <limits>

#include "catena/elements/pair_motion.hpp"

namespace catena {

template <class S>
struct RopeSpan {
  Vec2<S> s_i{}, s_j{};
  S radius_i{}, radius_j{};          // R_i, R_j
  S turn_i{}, turn_j{};              // a_i, a_j
  S constant{};                      // c
  Vec2<double> direction{1.0, 0.0};  // u in the given configuration
  double angle = 0;                  // its theta

  /// A vector along the stretch, of the length l |h|^2 where that is known; and l.
  template <class T>
  struct Line {
    Vec2<T> along;
    T length;
  };
  template <class T>
  Line<T> line(const Vec2<T>& h) const {
    using std::sqrt;
    const T offset = T(radius_j - radius_i);
    const T length = sqrt(squared_norm(h) - offset * offset);
    return {length * h - offset * perpendicular(h), length};
  }
  /// Whether there is a tangent.
  template <class T>
  bool exists(const Vec2<T>& h) const {
    const double offset = value_of(radius_j - radius_i);
    return value_of(squared_norm(h)) > offset * offset;
  }

  /// theta.
  template <class T>
  T heading(const Vec2<T>& along) const {
    using std::atan2;
    const Vec2<T> from{T(direction.x), T(direction.y)};
    return T(angle) + atan2(cross(from, along), dot(from, along));
  }
  /// f.
  template <class T>
  T extent(const Frame<T>& i, const Frame<T>& j) const {
    const Line<T> straight = line(separation(i, j, s_i, s_j));
    T sum = straight.length + T(turn_i) * i.phi + T(turn_j) * j.phi + T(constant);
    if (value_of(radius_i) != value_of(radius_j)) sum = sum + T(radius_i - radius_j) * heading(straight.along);
    return sum;
  }

  /// How the rope comes to this stretch and leaves it, for the angles over which it touches its circles.
  struct Neighbours {
    bool follows = false;  ///< the stretch before ends on the same circle, over which the rope slides
    // Directions of stretches between two points of body i, before, or of body j, after: theta - phi. NaN: none.
    double before = std::numeric_limits<double>::quiet_NaN(), after = std::numeric_limits<double>::quiet_NaN();
  };
  Neighbours next_to;

  /// u in plain numbers.
  Vec2<double> unit(const Vec2<double>& h) const { return line(h).along / squared_norm(h); }
  /// f_q, three entries a body.
  void gradient(const PairGeometry& g, double* entries) const {
    const Vec2<double> u = unit(g.h);
    entries[0] = -u.x;
    entries[1] = -u.y;
    entries[2] = turn_i - cross(g.arm_i, u);
    entries[3] = u.x;
    entries[4] = u.y;
    entries[5] = turn_j + cross(g.arm_j, u);
  }
  /// The part of fdd that velocities make.
  double bend(const PairMotion& m) const {
    const Vec2<double> u = unit(m.h);
    const double across = cross(u, m.hd);
    return dot(u, m.hdd) + across * across / line(m.h).length;
  }
};

}  // namespace catena
