// A vector in the plane, and the operations planar mechanics needs of it.
//
//   cross(a, b) = a.x b.y - a.y b.x        perpendicular(a) = R a = [-a.y, a.x]
//
// The component type is any scalar of base/ (double, Dual, Taylor), so that one formula serves values and derivatives.
#pragma once

#include <cmath>

namespace catena {

template <class T>
struct Vec2 {
  T x{}, y{};

  friend constexpr Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator-(const Vec2& a) { return {-a.x, -a.y}; }
  friend constexpr Vec2 operator*(const T& k, const Vec2& a) { return {k * a.x, k * a.y}; }
  friend constexpr Vec2 operator*(const Vec2& a, const T& k) { return {a.x * k, a.y * k}; }
  friend constexpr Vec2 operator/(const Vec2& a, const T& k) { return {a.x / k, a.y / k}; }
  constexpr Vec2& operator+=(const Vec2& a) { return *this = *this + a; }
  constexpr Vec2& operator-=(const Vec2& a) { return *this = *this - a; }
  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

template <class T>
constexpr T dot(const Vec2<T>& a, const Vec2<T>& b) {
  return a.x * b.x + a.y * b.y;
}

template <class T>
constexpr T cross(const Vec2<T>& a, const Vec2<T>& b) {
  return a.x * b.y - a.y * b.x;
}

/// R a: the vector turned counter-clockwise by a right angle.
template <class T>
constexpr Vec2<T> perpendicular(const Vec2<T>& a) {
  return {-a.y, a.x};
}

template <class T>
constexpr T squared_norm(const Vec2<T>& a) {
  return dot(a, a);
}

/// Length of `a`. For autodiff scalars the derivative does not exist at a = 0.
template <class T>
T norm(const Vec2<T>& a) {
  using std::sqrt;
  return sqrt(squared_norm(a));
}

}  // namespace catena
