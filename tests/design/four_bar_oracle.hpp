// A four-bar linkage in closed form, and derivatives of it by differences in long double: nothing of catena is in it.
//
//   crank a at angle w t + s, ground d, coupler b, rocker c, open assembly; pen at (u, v) from the coupler's start
//   the coupler's end is where circles of radius b and c about the crank's end and (d, 0) meet above the line between
#pragma once

#include <array>
#include <cmath>
#include <functional>

namespace catena::testing {

struct FourBar {
  long double a, b, c, d, u, v, w, s;
};

struct FourBarPose {
  long double coupler, rocker, pen_x, pen_y;
};

inline FourBarPose pose_of(const FourBar& f, long double t) {
  const long double angle = f.w * t + f.s, x = f.a * std::cos(angle), y = f.a * std::sin(angle);
  const long double dx = f.d - x, dy = -y, e2 = dx * dx + dy * dy, e = std::sqrt(e2);
  const long double along = (f.b * f.b - f.c * f.c + e2) / (2 * e), across = std::sqrt(f.b * f.b - along * along);
  const long double bx = x + (along * dx - across * dy) / e, by = y + (along * dy + across * dx) / e;
  const long double coupler = std::atan2(by - y, bx - x), rocker = std::atan2(by, bx - f.d);
  return {coupler, rocker, x + f.u * std::cos(coupler) - f.v * std::sin(coupler),
          y + f.u * std::sin(coupler) + f.v * std::cos(coupler)};
}

/// Derivative of f at 0 by central differences at h, h/2, h/4 and h/8, extrapolated: error of the order h^8.
inline long double differentiate(const std::function<long double(long double)>& f, long double h) {
  std::array<long double, 4> d{};
  for (std::size_t k = 0; k < 4; ++k, h /= 2) d[k] = (f(h) - f(-h)) / (2 * h);
  for (std::size_t level = 1; level < 4; ++level) {
    const long double factor = std::pow(4.0L, static_cast<long double>(level));
    for (std::size_t k = 3; k >= level; --k) d[k] = (factor * d[k] - d[k - 1]) / (factor - 1);
  }
  return d[3];
}

}  // namespace catena::testing
