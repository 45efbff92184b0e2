// The pose of a body: position of its frame's origin, its angle, and the angle's cosine and sine.
//
//   A = [[c, -s], [s, c]]      r_P = r + A s'_P      v = A v'
//
// c and s are stored so that cosine and sine are computed once per body and configuration, not once per element; the
// seeded frames below get theirs from dc = -s dphi, ds = c dphi. Units: m, m, rad. Source: Haug, sections 2.4-2.6.
#pragma once

#include "catena/base/dual.hpp"
#include "catena/base/taylor.hpp"
#include "catena/base/vec2.hpp"

namespace catena {

template <class T>
struct Frame {
  T x{}, y{}, phi{}, c{1.0}, s{};

  /// r + A local: the place of a point fixed in the body.
  template <class S>
  constexpr Vec2<T> point(const Vec2<S>& local) const {
    const T u(local.x), v(local.y);
    return {x + c * u - s * v, y + s * u + c * v};
  }
  /// A local: a direction fixed in the body, seen in the ground frame.
  template <class S>
  constexpr Vec2<T> axis(const Vec2<S>& local) const {
    const T u(local.x), v(local.y);
    return {c * u - s * v, s * u + c * v};
  }
  /// A^T v: a ground vector seen in the body frame.
  constexpr Vec2<T> to_local(const Vec2<T>& v) const { return {c * v.x + s * v.y, c * v.y - s * v.x}; }
  constexpr Vec2<T> origin() const { return {x, y}; }
};

/// The frame at (x, y, phi) with its trigonometry.
template <class T>
Frame<T> make_frame(const T& x, const T& y, const T& phi) {
  using std::cos, std::sin;
  return {x, y, phi, cos(phi), sin(phi)};
}

/// The ground, and any body that stays where it is.
template <class T>
Frame<T> constant_frame(const Frame<double>& f) {
  return {T(f.x), T(f.y), T(f.phi), T(f.c), T(f.s)};
}

/// `f` with x, y, phi as the independent variables first, first + 1, first + 2.
template <class T, int N>
Frame<Dual<T, N>> seed(const Frame<T>& f, int first) {
  using D = Dual<T, N>;
  Frame<D> r{D::variable(f.x, first), D::variable(f.y, first + 1), D::variable(f.phi, first + 2), D(f.c), D(f.s)};
  r.c.d[static_cast<std::size_t>(first + 2)] = -f.s;
  r.s.d[static_cast<std::size_t>(first + 2)] = f.c;
  return r;
}

/// `f` moving with the constant velocities (vx, vy, omega): q + qd t with no acceleration.
template <class T>
Frame<Taylor<T>> moving(const Frame<T>& f, const T& vx, const T& vy, const T& omega) {
  return {{f.x, vx, T(0)},
          {f.y, vy, T(0)},
          {f.phi, omega, T(0)},
          {f.c, -f.s * omega, -f.c * omega * omega},
          {f.s, f.c * omega, -f.s * omega * omega}};
}

}  // namespace catena
