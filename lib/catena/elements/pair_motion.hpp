// The vector h between the attachment points of two bodies and its derivatives, from which closed forms are built.
//
//   h = r_Pj - r_Pi      hd = rd_Pj - rd_Pi      hdd = phid_i^2 A_i s'Pi - phid_j^2 A_j s'Pj   (no accelerations)
//
// Units: m, m/s, m/s2. Source: Haug, section 3.3.
#pragma once

#include "catena/elements/element.hpp"

namespace catena {

/// h in the scalar of the frames.
template <class T, class S>
Vec2<T> separation(const Frame<T>& i, const Frame<T>& j, const Vec2<S>& s_i, const Vec2<S>& s_j) {
  return j.point(s_j) - i.point(s_i);
}

struct PairGeometry {
  Vec2<double> arm_i, arm_j, h;  // A_i s'Pi, A_j s'Pj, h

  PairGeometry(const Arguments<double>& a, const Vec2<double>& s_i, const Vec2<double>& s_j)
      : arm_i(a.i.axis(s_i)), arm_j(a.j.axis(s_j)), h(Vec2<double>{a.j.x - a.i.x, a.j.y - a.i.y} + (arm_j - arm_i)) {}
};

struct PairMotion : PairGeometry {
  Vec2<double> hd, hdd;

  PairMotion(const Arguments<double>& a, const Vec2<double>& s_i, const Vec2<double>& s_j, const Rates& u,
             const Rates& v)
      : PairGeometry(a, s_i, s_j),
        hd(Vec2<double>{v.vx - u.vx, v.vy - u.vy} + v.omega * perpendicular(arm_j) - u.omega * perpendicular(arm_i)),
        hdd((u.omega * u.omega) * arm_i - (v.omega * v.omega) * arm_j) {}
};

/// `axis` as a unit vector; a zero axis stays zero, for check() to refuse.
template <class S>
void normalise(Vec2<S>& axis) {
  if (value_of(squared_norm(axis)) > 0) axis = axis / norm(axis);
}

/// Whether `axis` has a direction.
template <class S>
bool has_direction(const Vec2<S>& axis) {
  return value_of(squared_norm(axis)) > 0;
}

}  // namespace catena
